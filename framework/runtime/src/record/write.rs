//! Writing a recording.

use super::messages::Message;
use super::{Channel, Record};
use mcap::records::MessageHeader;
use mcap::{McapError, WriteOptions};
use seeone_core::Diagnostic;
use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter};
use std::path::Path;

/// Writes a run's recording to `path`: under `path.partial` first, so that a file of the
/// right name is whole.
///
/// # Errors
/// `K001` when it cannot be written; no file of the right name is then left.
pub(crate) fn write(path: &Path, record: &Record) -> Result<(), Diagnostic> {
    let mut partial = OsString::from(path);
    partial.push(".partial");
    let partial = Path::new(&partial);
    write_messages(partial, &record.messages())
        .and_then(|()| Ok(fs::rename(partial, path)?))
        .map_err(|e| {
            Diagnostic::new("K001", format!("cannot write the recording: {e}")).in_file(path)
        })
}

fn write_messages(path: &Path, messages: &[Message]) -> Result<(), McapError> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    let mut writer = WriteOptions::new()
        .compression(None)
        .library("seeone")
        .create(BufWriter::new(File::create(path)?))?;
    let mut ids = BTreeMap::new();
    for channel in Channel::ALL {
        let schema = channel.schema().to_string();
        let schema = writer.add_schema(&channel.schema_name(), "jsonschema", schema.as_bytes())?;
        let id = writer.add_channel(schema, channel.topic(), "json", &BTreeMap::new())?;
        ids.insert(channel, (id, 0));
    }
    for message in messages {
        let Some((channel_id, sequence)) = ids.get_mut(&message.channel) else { continue };
        let time = (message.time_s.max(0.0) * 1e9).round() as u64;
        let header = MessageHeader {
            channel_id: *channel_id,
            sequence: *sequence,
            log_time: time,
            publish_time: time,
        };
        *sequence += 1;
        writer.write_to_known_channel(&header, message.body.to_string().as_bytes())?;
    }
    writer.finish()?;
    let file = writer.into_inner().into_inner().map_err(io::IntoInnerError::into_error)?;
    Ok(file.sync_all()?)
}
