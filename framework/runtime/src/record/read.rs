//! Reading a recording.

use super::Channel;
use mcap::MessageStream;
use seeone_core::Diagnostic;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// The largest recording that is read into memory.
const MOST_BYTES: u64 = 1 << 30;

/// One message.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// Its channel.
    pub channel: Channel,
    /// Its time, seconds of the cell's clock.
    pub time_s: f64,
    /// What it says.
    pub body: Value,
}

/// A recording that was read whole.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recording {
    /// The messages in the order of the file.
    pub entries: Vec<Entry>,
}

impl Recording {
    /// The messages of one channel.
    pub fn of(&self, channel: Channel) -> impl Iterator<Item = &Entry> {
        self.entries.iter().filter(move |entry| entry.channel == channel)
    }

    /// Time of the last message, seconds.
    pub fn duration_s(&self) -> f64 {
        self.entries.iter().map(|entry| entry.time_s).fold(0.0, f64::max)
    }
}

/// Reads a recording and checks it: every checksum, every channel, every message JSON.
///
/// # Errors
/// `K002` a file that cannot be read, `K003` one that is damaged or cut short, `K004` one
/// that is no recording of a run.
pub fn read(path: &Path) -> Result<Recording, Diagnostic> {
    let fault = |code, cause: String| Diagnostic::new(code, cause).in_file(path);
    let unreadable = |e: std::io::Error| fault("K002", format!("cannot be read: {e}"));
    if fs::metadata(path).map_err(unreadable)?.len() > MOST_BYTES {
        return Err(fault("K002", format!("more than {MOST_BYTES} bytes")));
    }
    let bytes = fs::read(path).map_err(unreadable)?;
    let damaged = |e: mcap::McapError| fault("K003", format!("damaged or cut short: {e}"));
    let mut entries = Vec::new();
    for message in MessageStream::new(&bytes).map_err(damaged)? {
        let message = message.map_err(damaged)?;
        let topic = message.channel.topic.as_str();
        let channel = Channel::ALL
            .into_iter()
            .find(|channel| channel.topic() == topic)
            .ok_or_else(|| fault("K004", format!("no recording of a run: topic {topic:?}")))?;
        let body = serde_json::from_slice(&message.data)
            .map_err(|e| fault("K003", format!("a message of {topic} is not JSON: {e}")))?;
        entries.push(Entry { channel, time_s: message.log_time as f64 * 1e-9, body });
    }
    match entries.first() {
        Some(entry) if entry.channel == Channel::Run => Ok(Recording { entries }),
        _ => Err(fault("K004", "no recording of a run: it does not begin with /run".into())),
    }
}
