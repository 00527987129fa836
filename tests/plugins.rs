//! Plugins from dynamic libraries in whole runs of the binary: served like linked ones, and
//! survived when they misbehave.

mod support;

use seeone_plugin::abi::{Library, LoadedPlugin, Manifest, Offer};
use seeone_plugin::conformance::{self, StillWorld, Violation, arm};
use seeone_plugin::{Kind, PluginError, Setup};
use seeone_runtime::record::{Channel, read};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::time::{Duration, Instant};
use support::{Bench, Call, root, seeone};
use tempfile::TempDir;

const SKILL: &str = "skills/cap-wearing.toml";

/// The built-in plugins as libraries: package and example.
const LIBRARIES: [(&str, &str); 9] = [
    ("seeone-camera-sim", "camera-sim"),
    ("seeone-nst", "nst"),
    ("seeone-nse", "nse"),
    ("seeone-procrustes", "procrustes"),
    ("seeone-feature-match", "feature-match"),
    ("seeone-unchanged", "unchanged"),
    ("seeone-qp-ik", "qp-ik"),
    ("seeone-motion", "motion"),
    ("seeone-ur5-ag95-sim", "ur5-ag95-sim"),
];

/// Builds libraries and copies them into a folder of their own.
fn built(libraries: &[(&str, &str)]) -> (TempDir, Vec<String>) {
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["build", "--release", "--quiet"]).current_dir(root());
    for (package, example) in libraries {
        cargo.args(["-p", package, "--example", example]);
    }
    assert!(cargo.status().expect("cargo starts").success(), "the libraries cannot be built");
    let target = Path::new(env!("CARGO_BIN_EXE_seeone")).ancestors().nth(2).expect("a folder");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let copied = libraries.iter().map(|(_, example)| {
        let name = format!(
            "{}{}{}",
            std::env::consts::DLL_PREFIX,
            example.replace('-', "_"),
            std::env::consts::DLL_SUFFIX
        );
        let copy = folder.path().join(&name);
        fs::copy(target.join("release/examples").join(name), &copy).expect("the library");
        copy.display().to_string()
    });
    let copied = copied.collect();
    (folder, copied)
}

fn trust(library: &str) {
    let trusted = seeone(["plugins", "trust", library]);
    assert_eq!(trusted.status, Some(0), "{}", trusted.stderr);
}

/// What a run told, but for what a clock measured and where the files went; and its recording.
fn told(call: &Call) -> (Value, PathBuf) {
    let mut outcome: Value = serde_json::from_str(&call.stdout).expect("one JSON object");
    let keys = outcome.as_object_mut().expect("an object");
    keys.remove("timings_ms");
    let recording = keys.remove("recording").expect("a recording");
    for stage in outcome["stages"].as_array_mut().expect("stages") {
        stage.as_object_mut().expect("a stage").remove("seconds");
    }
    (outcome, recording.as_str().expect("a path").into())
}

#[test]
fn a_run_with_every_plugin_loaded_is_the_run_with_every_plugin_linked() {
    let (folder, libraries) = built(&LIBRARIES);
    libraries.iter().for_each(|library| trust(library));
    let run = |name: &str, libraries: &[String]| {
        let out = folder.path().join(name).display().to_string();
        let mut words = vec!["run", SKILL, "--json", "--seed", "0", "--out", &out];
        libraries.iter().for_each(|library| words.extend(["--plugin", library]));
        let call = seeone(&words);
        assert!(matches!(call.status, Some(0 | 1)), "{}", call.stderr);
        let (outcome, recording) = told(&call);
        (call.status, outcome, fs::read(recording).expect("a recording"))
    };
    let (linked, loaded) = (run("linked", &[]), run("loaded", &libraries));
    assert_eq!((linked.0, linked.1), (loaded.0, loaded.1));
    assert!(linked.2 == loaded.2, "the recordings differ");
}

/// Features a point of the shipped perception.
const WIDTH: usize = 128;

/// A camera over the suite's block, looking down; the recorded one shows the demonstration.
const CAMERA: &str = "
    pose = { xyz_m = [0.5, 0.0, 0.8], quat_xyzw = [1, 0, 0, 0] }
    intrinsics = { width = 160, height = 120, fx = 96, fy = 96, cx = 79.5, cy = 59.5 }
    crop = { centre_xy_m = [0.5, 0.0], half_extents_m = [0.25, 0.25], floor_m = 0.0, height_m = 0.4 }
    cloud = \"skills/cap-wearing/demonstration.ply\"
";

/// Holds a loaded plugin to the rules of its kind.
fn holds(offer: &Offer) -> Result<(), Violation> {
    let (root, model, kind) = (root(), arm(), offer.id.kind);
    let config = if kind == Kind::Camera { CAMERA } else { "" }.parse().expect("TOML");
    let build = || -> Result<LoadedPlugin, PluginError> {
        let setup = Setup {
            config: &config,
            root: &root,
            seed: 1,
            robot: Some(&model),
            world: Some(Arc::new(StillWorld::default())),
        };
        offer.build(&setup, Some(Duration::from_secs(120)))
    };
    let mut plugin = build().expect("built");
    match kind {
        Kind::Camera => conformance::camera(&|| Ok(Box::new(build()?))),
        Kind::Perception => conformance::perception(&mut plugin),
        Kind::Encoding => conformance::encoding(&mut plugin, WIDTH),
        Kind::Alignment => conformance::alignment(&plugin),
        Kind::Transfer => conformance::transfer(&plugin),
        Kind::Kinematics => conformance::kinematics(&plugin),
        Kind::Motion => conformance::motion(&plugin),
        Kind::Robot => conformance::robot(&model, &|| Ok(Box::new(build()?))),
    }
}

#[test]
fn every_plugin_keeps_the_rules_of_its_kind_when_it_is_loaded() {
    let (_folder, libraries) = built(&LIBRARIES);
    let mut held = 0;
    for path in &libraries {
        Manifest::write_for(Path::new(path)).expect("a sound library");
        for offer in Library::open(Path::new(path)).expect("trusted").offers() {
            holds(offer).unwrap_or_else(|broken| panic!("{}: {broken}", offer.id));
            held += 1;
        }
    }
    assert_eq!(held, 17);
}

#[test]
fn a_run_survives_a_plugin_that_misbehaves_and_says_which() {
    let (_folder, libraries) = built(&[("seeone-plugin", "misbehaving")]);
    let library = &libraries[0];
    trust(library);
    for (kind, deed, entry, reason) in [
        ("transfer", "panic", "transfer", "a panic: as it was told"),
        ("transfer", "hang", "transfer", "no sign of life for 2 s"),
        (
            "transfer",
            "nan",
            "transfer",
            "its answer is not to be believed: a candidate is out of its range",
        ),
        (
            "transfer",
            "nothing",
            "transfer",
            "its answer is not to be believed: there is no candidate",
        ),
        ("transfer", "silence", "transfer", "it failed with status 4 and said nothing"),
        ("robot", "panic", "execute", "a panic: as it was told"),
        ("robot", "hang", "execute", "no sign of life for 2 s"),
        (
            "robot",
            "nan",
            "execute",
            "its answer is not to be believed: the fingers are NaN m apart",
        ),
        (
            "robot",
            "nothing",
            "state",
            "its answer is not to be believed: 0 joints of a robot with 6",
        ),
        ("robot", "silence", "execute", "it failed with status 4 and said nothing"),
        ("robot", "freeze", "execute", "no sign of life for 2 s"),
        ("robot", "deaf", "execute", "it does not move"),
    ] {
        let bench = Bench::new();
        bench.append("robots/ur5-ag95-sim.toml", &format!("\n[config.{kind}]\ndo = \"{deed}\"\n"));
        let method = format!("{kind}=misbehaving");
        let patience = ["--plugin-patience", "2", "--tries", "1", "--json"];
        let words = ["--plugin", library, "--method", &method];
        let began = Instant::now();
        let call = bench.run(&[&words[..], &patience[..]].concat());
        assert_eq!(call.status, Some(1), "{kind} {deed}: {}", call.stderr);
        let (outcome, recording) = told(&call);
        let why = outcome["reason"].as_str().expect("a reason");
        let whose = format!("{kind} plugin \"misbehaving\" in \"{entry}\": {reason}");
        assert!(why.contains(&whose), "{kind} {deed}: {why}");
        // The robot is asked to stop, and one that does not answer is told of.
        let stages = outcome["stages"].as_array().expect("stages");
        let deaf = stages.iter().find(|stage| stage["name"] == "stop");
        let deaf = deaf.map(|stage| stage["reason"].as_str().expect("a reason"));
        let warned = |why: &str| {
            why.contains("may be moving and where it is is not known, so use its emergency stop")
                && why.contains("robot plugin \"misbehaving\" in \"stop\": ")
        };
        assert!(deaf.is_none_or(warned), "{deaf:?}");
        let answers = kind != "robot" || ["nan", "nothing"].contains(&deed);
        assert_eq!(deaf.is_none(), answers, "{kind} {deed}: {outcome}");
        // It waits for the plugin once, and not again.
        assert!(began.elapsed() < Duration::from_secs(90), "{kind} {deed}: {:?}", began.elapsed());
        let recording = read(&recording).expect("a whole recording");
        // What was seen of the robot until then is in it.
        let frozen = deed == "freeze";
        let seen = recording.of(Channel::Robot).any(|entry| entry.time_s == 0.5);
        assert!(!frozen || seen, "{kind} {deed}");
        let verdict = &recording.of(Channel::Verdict).last().expect("a verdict").body;
        assert_eq!(verdict["success"], false, "{kind} {deed}");
    }
}

#[test]
fn a_library_is_checked_in_a_process_of_its_own() {
    let (folder, libraries) = built(&[("seeone-plugin", "misbehaving")]);
    let library = &libraries[0];
    let checked = seeone(["plugins", "check", library]);
    assert_eq!(checked.status, Some(0), "{}", checked.stderr);
    assert!(checked.stdout.contains("transfer \"misbehaving\""), "{}", checked.stdout);
    assert!(checked.stdout.contains("not trusted"), "{}", checked.stdout);
    let listed = || seeone(["plugins", "list", &folder.path().display().to_string()]).stdout;
    assert!(listed().contains("refused: the library has no readable manifest"), "{}", listed());
    trust(library);
    assert!(listed().contains("trusted: transfer \"misbehaving\""), "{}", listed());

    let whole = fs::read(library).expect("the library");
    let damaged = |bytes: &[u8], what: String| {
        fs::write(library, bytes).expect("a damaged library");
        assert!(listed().contains("refused: the library has"), "{what}: {}", listed());
        // Whatever becomes of the process that loads it, the answer is one of this program's.
        let checked = seeone(["plugins", "check", library]);
        assert!(matches!(checked.status, Some(0..=2)), "{what}: {:?}", checked.status);
        let named = checked.status == Some(0) || checked.stderr.contains("libmisbehaving");
        assert!(named, "{what}: {}", checked.stderr);
    };
    for part in 0..64 {
        let at = whole.len() * part / 64;
        damaged(&whole[..at], format!("the first {at} bytes"));
        let mut flipped = whole.clone();
        flipped[at] ^= 0x10;
        damaged(&flipped, format!("byte {at} flipped"));
    }
}

#[test]
fn check_knows_the_plugins_of_libraries_that_it_is_given() {
    let (_folder, libraries) = built(&[("seeone-plugin", "misbehaving")]);
    let (bench, library) = (Bench::new(), &libraries[0]);
    bench.set_line(SKILL, "transfer", "transfer = \"misbehaving\"");
    let file = bench.arg(SKILL);
    let unknown = seeone(["check", &file]);
    assert_eq!(unknown.status, Some(1), "{}", unknown.stderr);
    assert!(unknown.stderr.contains("error[S024]"), "{}", unknown.stderr);
    let untrusted = seeone(["check", &file, "--plugin", library]);
    assert_eq!(untrusted.status, Some(2), "{}", untrusted.stderr);
    trust(library);
    let known = seeone(["check", &file, "--plugin", library]);
    assert_eq!(known.status, Some(0), "{}", known.stderr);
    bench.set_line(SKILL, "transfer", "transfer = \"misbehavin\"");
    let close = seeone(["check", &file, "--plugin", library]);
    assert!(close.stderr.contains("did you mean \"misbehaving\"?"), "{}", close.stderr);
}

#[test]
fn two_libraries_with_one_name_are_refused() {
    let (folder, libraries) = built(&[("seeone-unchanged", "unchanged")]);
    let twin = folder.path().join("twin.so").display().to_string();
    fs::copy(&libraries[0], &twin).expect("a copy");
    trust(&libraries[0]);
    trust(&twin);
    let call = seeone(["run", SKILL, "--plugin", &libraries[0], "--plugin", &twin]);
    assert_eq!(call.status, Some(2), "{}", call.stderr);
    assert!(call.stderr.contains("L012") && call.stderr.contains("\"snap\""), "{}", call.stderr);
    assert!(call.stderr.contains("twin.so"), "{}", call.stderr);
}
