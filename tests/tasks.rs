//! Whole tasks of the binary, and runs that Ctrl-C ends.

#![allow(clippy::print_stderr, reason = "a skipped test says so")]

mod support;

use seeone_runtime::record::read;
use serde_json::Value;
use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use support::{Call, root, seeone};
use tempfile::TempDir;

const SEED: &str = "0";

/// A task carried out, and what `--json` told of it.
fn carried_out(folder: &TempDir, words: &[&str]) -> (Call, Value) {
    let out = folder.path().display().to_string();
    let call = seeone([&["run"], words, &["--json", "--seed", SEED, "--out", &out]].concat());
    assert!(matches!(call.status, Some(0 | 1)), "{:?} {}", call.status, call.stderr);
    let told: Value = serde_json::from_str(&call.stdout).expect("one JSON object");
    assert_eq!(told["success"] == true, call.status == Some(0), "{told}");
    (call, told)
}

#[test]
fn a_task_looks_again_and_tells_its_steps_as_a_tree() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (call, told) = carried_out(&folder, &["skills/tasks/dress.toml"]);
    assert_eq!(
        (&told["task"], &told["tree"]["composition"]),
        (&"dress".into(), &"sequence".into())
    );
    let wear = &told["tree"]["steps"][0];
    assert_eq!(wear["name"], "wear");
    assert!(wear["seconds"].as_f64().is_some_and(|seconds| seconds > 0.0), "{wear}");
    let runs = wear["runs"].as_array().expect("runs");
    assert_eq!(Some(runs.len() as u64), wear["tries"].as_u64());
    // All but the last failed, or left the cap otherwise than it was shown, and the last says how
    // the step ended.
    let failed = |run: &Value| !run["failed_at"].is_null() || run["as_shown"] == false;
    let (last, before) = runs.split_last().expect("a run");
    assert!(before.iter().all(failed), "{told}");
    assert_eq!(failed(last), wear["state"] == "failed");
    assert!(!failed(last) || runs.len() == 3, "{told}");
    for (index, run) in runs.iter().enumerate() {
        let first = if index == 0 { "require" } else { "withdraw" };
        assert_eq!(run["stages"][0]["name"], first, "{run}");
        read(Path::new(run["recording"].as_str().expect("a recording")))
            .expect("a sound recording");
    }
    for line in ["dress", "wear"] {
        assert!(
            call.stderr.lines().filter(|told| told.contains(line)).count() >= 2,
            "{}",
            call.stderr
        );
    }
}

#[test]
fn every_cap_on_the_table_has_its_turn_and_its_hook() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let words = ["skills/tasks/tidy-caps.toml", "--scene", "scenes/hooks.toml"];
    let (call, told) = carried_out(&folder, &words);
    let hang = &told["tree"]["steps"][0];
    assert_eq!(hang["composition"], "visible");
    let turns = hang["steps"].as_array().expect("turns");
    let names: Vec<&str> = turns.iter().filter_map(|turn| turn["name"].as_str()).collect();
    assert_eq!(names, ["hang-hook", "hang-hook-2", "hang-hook-3"]);
    let done: Vec<&Value> = turns.iter().filter(|turn| turn["state"] == "done").collect();
    assert!(!done.is_empty(), "{}", call.stderr);
    for turn in &done {
        let run = turn["runs"].as_array().and_then(|runs| runs.last()).expect("a run");
        assert_eq!(run["skill"], "cap-hanging");
        assert!(run["failed_at"].is_null() && run["success"].is_boolean(), "{run}");
        read(Path::new(run["recording"].as_str().expect("a recording"))).expect("sound");
    }
    // Where every cap hangs, each of the three turns ended well and nothing is left.
    let hung = |turn: &&&Value| {
        turn["runs"].as_array().and_then(|runs| runs.last()).is_some_and(|r| r["success"] == true)
    };
    let all = done.iter().filter(hung).count() == 3;
    assert_eq!(told["success"] == true, all, "{}", call.stderr);
}

/// Ends a run by Ctrl-C as soon as it tells that `step` is done; its status and all that was told.
fn interrupted(out: &Path, skill: &str, step: &str) -> (Option<i32>, String) {
    let mut child = Command::new(env!("CARGO_BIN_EXE_seeone"))
        .args(["run", skill, "--seed", SEED, "--out"])
        .arg(out)
        .current_dir(root())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the binary starts");
    let mut lines = BufReader::new(child.stderr.take().expect("a pipe"));
    let mut told = String::new();
    while !told.lines().last().is_some_and(|last| last.split_whitespace().take(2).eq(["ok", step]))
    {
        assert!(lines.read_line(&mut told).expect("text") > 0, "it ended before: {told}");
    }
    let signalled = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(signalled.is_ok_and(|status| status.success()), "no signal was sent");
    lines.read_to_string(&mut told).expect("text");
    (child.wait().expect("an end").code(), told)
}

/// The recordings in a folder.
fn recordings(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("the folder").filter_map(Result::ok);
    let paths = entries.map(|entry| entry.path());
    paths.filter(|path| path.extension().is_some_and(|e| e == "mcap")).collect()
}

#[test]
fn ctrl_c_stops_the_robot_and_leaves_a_whole_recording() {
    if !cfg!(unix) {
        eprintln!("skipped: no signals here");
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, task) in [("run", "skills/cap-wearing.toml"), ("task", "skills/tasks/dress.toml")] {
        let out = folder.path().join(name);
        let (status, told) = interrupted(&out, task, "plan");
        assert_eq!(status, Some(130), "{told}");
        assert!(told.contains(": interrupted"), "{told}");
        assert!(!told.contains("may be moving"), "{told}");
        let [recording] = &recordings(&out)[..] else { panic!("no one recording: {told}") };
        assert!(!read(recording).expect("a whole recording").entries.is_empty());
    }
}
