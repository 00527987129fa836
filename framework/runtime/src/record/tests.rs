#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::fakes::{Behaviour, FakeCell};
use crate::run::{Hooks, run};
use mcap::Summary;
use std::fs;
use std::path::PathBuf;

fn recorded(cell: &FakeCell) -> PathBuf {
    let mut assignment = cell.assignment();
    let path = cell.folder.path().join("runs/a.mcap");
    assignment.recording = Some(path.clone());
    let outcome = run(assignment, cell.plugins(Behaviour::default()), Hooks::default()).outcome;
    assert_eq!(outcome.recording.as_ref(), Some(&path));
    path
}

#[test]
fn every_channel_is_there_with_its_schema_and_messages() {
    let cell = FakeCell::new();
    let path = recorded(&cell);
    let bytes = fs::read(&path).unwrap();
    let summary = Summary::read(&bytes).unwrap().unwrap();
    let mut topics: Vec<_> = summary.channels.values().map(|c| c.topic.clone()).collect();
    topics.sort();
    let mut expected = Channel::ALL.map(Channel::topic);
    expected.sort_unstable();
    assert_eq!(topics, expected);
    assert!(summary.channels.values().all(|channel| {
        let schema = channel.schema.as_ref().unwrap();
        channel.message_encoding == "json" && schema.encoding == "jsonschema"
    }));
    let recording = read(&path).unwrap();
    for channel in Channel::ALL {
        assert!(recording.of(channel).count() > 0, "{}", channel.topic());
    }
    assert!(!path.with_extension("mcap.partial").exists());
}

#[test]
fn messages_have_the_keys_of_their_schema_and_the_cells_time() {
    let cell = FakeCell::new();
    let recording = read(&recorded(&cell)).unwrap();
    for entry in &recording.entries {
        let properties = entry.channel.schema()["properties"].as_object().unwrap().clone();
        for key in properties.keys() {
            assert!(entry.body.get(key).is_some(), "{} lacks {key}", entry.channel.topic());
        }
    }
    // Five actions of a second at 30 Hz from 2 s on; the object at 10 Hz and at the end.
    assert_eq!(recording.of(Channel::Robot).count(), 150 + 30);
    let objects = recording.of(Channel::Object).count();
    assert!((58..=64).contains(&objects), "{objects}");
    assert!((recording.duration_s() - 8.0).abs() < 1e-6, "{}", recording.duration_s());
    assert!(recording.entries.windows(2).all(|pair| pair[0].time_s <= pair[1].time_s));
    let object = recording.of(Channel::Object).next().unwrap();
    assert_eq!(object.body["vertices"][0][0], 0.12346, "rounded to a hundredth of a millimetre");
}

#[test]
fn a_file_that_is_cut_or_changed_is_refused() {
    let cell = FakeCell::new();
    let path = recorded(&cell);
    let bytes = fs::read(&path).unwrap();
    let other = cell.folder.path().join("b.mcap");
    for cut in [0, 5, 100, bytes.len() / 2, bytes.len() - 1] {
        fs::write(&other, &bytes[..cut]).unwrap();
        assert!(read(&other).is_err(), "cut at {cut}");
    }
    let mut changed = bytes.clone();
    changed[bytes.len() / 3] ^= 0x10;
    fs::write(&other, &changed).unwrap();
    assert_eq!(read(&other).unwrap_err().code, "K003");
    assert_eq!(read(&cell.folder.path().join("none.mcap")).unwrap_err().code, "K002");
}
