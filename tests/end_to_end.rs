//! Whole runs of the binary on an unseen cap: what is printed, drawn and recorded, that
//! the same seed gives the same bytes, and that every plugin can take its part.

#![allow(clippy::print_stderr, reason = "a skipped test says so")]

mod support;

use seeone_runtime::record::{Channel, Recording, read};
use serde_json::Value;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use support::{Call, root, seeone};
use tempfile::TempDir;

const SKILL: &str = "skills/cap-wearing.toml";
const SEED: &str = "0";

/// A run of the shipped skill with the shipped robot and scene, and what it left.
struct Attempt {
    folder: TempDir,
    call: Call,
    outcome: Value,
}

impl Attempt {
    /// Makes it with `extra` arguments. Whatever becomes of it, it is an attempt: exit
    /// status 0 with success, 1 with a reason for the failure.
    fn new(extra: &[&str]) -> Self {
        Self::of(SKILL, extra)
    }

    /// The same with another skill.
    fn of(skill: &str, extra: &[&str]) -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let out = folder.path().display().to_string();
        let mut words = vec!["run", skill, "--json", "--seed", SEED, "--out", &out];
        words.extend(extra);
        let call = seeone(&words);
        assert!(matches!(call.status, Some(0 | 1)), "{extra:?}: {:?} {}", call.status, call.stderr);
        let outcome: Value = serde_json::from_str(&call.stdout).expect("one JSON object");
        assert!(!outcome["reason"].as_str().expect("a reason").is_empty(), "{extra:?}");
        let dry = extra.contains(&"--dry-run");
        assert_eq!(outcome["success"] == true, call.status == Some(0) && !dry, "{outcome}");
        Self { folder, call, outcome }
    }

    /// The bytes of the recording.
    fn recording(&self) -> Vec<u8> {
        fs::read(self.recording_path()).expect("a recording")
    }

    fn recording_path(&self) -> PathBuf {
        PathBuf::from(self.outcome["recording"].as_str().expect("a recording"))
    }

    /// What was printed, without what a clock measured and where the files went.
    fn told(&self) -> Value {
        timeless(&self.outcome)
    }

    /// The files it left, by extension.
    fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.folder.path()).expect("the folder");
        let mut names: Vec<String> = entries
            .map(|e| e.expect("an entry").path())
            .map(|path| path.extension().expect("an extension").to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    fn stage(&self, name: &str) -> Option<&Value> {
        self.outcome["stages"].as_array()?.iter().find(|stage| stage["name"] == name)
    }
}

/// An outcome without `timings_ms`, the stages' `seconds` and the path of the recording.
fn timeless(outcome: &Value) -> Value {
    let mut told = outcome.clone();
    let keys = told.as_object_mut().expect("an object");
    keys.remove("timings_ms");
    keys.remove("recording");
    for stage in told["stages"].as_array_mut().expect("stages") {
        stage.as_object_mut().expect("a stage").remove("seconds");
    }
    told
}

#[test]
fn a_run_tells_draws_and_records_itself_and_its_seed_repeats_it() {
    let once = Attempt::new(&[]);
    for key in [
        "skill",
        "object",
        "robot",
        "seed",
        "methods",
        "grasped",
        "success",
        "error_m",
        "error_d",
        "tilt_deg",
        "nose_up_deg",
        "yaw_deg",
        "tries",
        "failed_at",
        "reason",
        "stages",
        "timings_ms",
        "recording",
    ] {
        assert!(once.outcome.get(key).is_some(), "{key} is missing in {}", once.call.stdout);
    }
    for stage in once.outcome["stages"].as_array().expect("stages") {
        assert!(stage["name"].is_string() && stage["ok"].is_boolean(), "{stage}");
        assert!(stage["seconds"].as_f64().is_some_and(|s| s >= 0.0), "{stage}");
        assert!(stage["reason"].is_string() || stage["ok"] == true, "{stage}");
    }
    assert!(once.outcome["tries"].as_u64().is_some_and(|n| (1..=3).contains(&n)));
    for name in ["pick", "hook", "cover", "level", "release"] {
        let stage = once.stage(name).expect("the run gets as far as the head");
        assert!(stage["ok"] == true, "{stage}");
    }
    for step in ["observe", "perceive", "encode", "transfer", "plan", "act"] {
        assert!(once.outcome["timings_ms"][step].as_f64().is_some_and(|ms| ms > 0.0), "{step}");
    }
    assert!(once.outcome["error_m"].as_f64().is_some_and(|e| e.is_finite() && e >= 0.0));
    assert_eq!(once.files(), ["csv", "mcap", "png"]);
    let recording = read(&once.recording_path()).expect("a sound recording");
    for channel in Channel::ALL {
        assert!(recording.of(channel).next().is_some(), "nothing in {}", channel.topic());
    }
    agrees(&recording, &once.outcome);

    let again = Attempt::new(&[]);
    assert_eq!(once.told(), again.told());
    assert!(once.recording() == again.recording(), "the recordings differ");
}

/// The recording ends as the run told, and the object moved as far as it lasted.
fn agrees(recording: &Recording, outcome: &Value) {
    let verdict = &recording.of(Channel::Verdict).last().expect("a verdict").body;
    for key in ["grasped", "success"] {
        assert_eq!(verdict[key], outcome[key], "{key}");
    }
    let run = &recording.of(Channel::Run).next().expect("a run").body;
    assert_eq!(run["methods"], outcome["methods"]);
    assert_eq!(run["seed"], outcome["seed"]);
    assert!(recording.duration_s() > 1.0);
    let times: Vec<f64> = recording.of(Channel::Robot).map(|entry| entry.time_s).collect();
    assert!(times.is_sorted(), "the robot's moments are out of order");
}

#[test]
fn a_dry_run_plans_and_moves_nothing() {
    let dry = Attempt::new(&["--dry-run"]);
    assert!(dry.outcome["timings_ms"].get("act").is_none_or(|ms| ms.as_f64() < Some(1.0)));
    assert!(dry.stage("pick").is_none(), "{}", dry.call.stdout);
    let recording = read(&dry.recording_path()).expect("a sound recording");
    let moments: Vec<&Value> = recording.of(Channel::Robot).map(|entry| &entry.body).collect();
    assert!(moments.iter().all(|body| body["joints"] == moments[0]["joints"]), "the robot moved");
    let planned = dry.stage("plan").is_some_and(|stage| stage["ok"] == true);
    assert_eq!(dry.call.status, Some(i32::from(!planned)), "{}", dry.call.stdout);
}

/// Height of the object's lowest vertex over the table in a recording's last moment, metres.
fn lowest_at_the_end(recording: &Recording) -> f64 {
    let end = recording.of(Channel::Object).last().expect("the object's last moment");
    let vertices = end.body["vertices"].as_array().expect("vertices");
    vertices.iter().map(|v| v[2].as_f64().expect("a height")).fold(f64::INFINITY, f64::min)
}

#[test]
fn a_cap_is_said_to_hang_only_where_it_does() {
    let hung = Attempt::of("skills/cap-hanging.toml", &["--scene", "scenes/hook.toml"]);
    let outcome = &hung.outcome;
    for key in ["error_m", "error_d", "tilt_deg", "yaw_deg"] {
        assert!(outcome[key].is_null(), "{key} is of wearing: {outcome}");
    }
    let recording = read(&hung.recording_path()).expect("a sound recording");
    agrees(&recording, outcome);
    let lowest = lowest_at_the_end(&recording);
    let reason = outcome["reason"].as_str().expect("a reason");
    if outcome["success"] == true {
        assert!(lowest > 0.005, "hangs {lowest} m over the table");
        assert_eq!(outcome["grasped"], true);
        assert_eq!(reason, format!("hangs {:.0} mm over the table", lowest * 1e3));
    }
    if reason.contains("on the table") {
        assert!(lowest < 0.005, "lies {lowest} m over the table");
    }
}

#[test]
fn a_cap_is_held_out_only_where_it_is() {
    let out = Attempt::of("skills/cap-handing-over.toml", &[]);
    let reason = out.outcome["reason"].as_str().expect("a reason");
    let told = reason.strip_prefix("held ").and_then(|rest| rest.split_once(" mm from person"));
    let near = told.is_some_and(|(off, _)| off.parse::<f64>().expect("a number") <= 80.0);
    assert_eq!(out.outcome["success"] == true, near, "{}", out.outcome);
    assert!(out.outcome["error_m"].is_null());
}

#[test]
fn every_other_plugin_reaches_an_honest_outcome() {
    for (kind, name) in [
        ("transfer", "unchanged"),
        ("transfer", "snap"),
        ("alignment", "ransac"),
        ("kinematics", "damped-least-squares"),
        ("motion", "joint-line"),
        ("robot", "ideal-sim"),
        ("encoding", "nearest-feature"),
        ("perception", "nst-one-pass"),
    ] {
        let attempt = Attempt::new(&["--method", &format!("{kind}={name}")]);
        assert_eq!(attempt.outcome["methods"][kind], name);
        assert!(attempt.stage("plan").is_some(), "{kind}={name}: {}", attempt.call.stdout);
    }
}

#[test]
fn one_word_swaps_the_robot() {
    for robot in ["ur5e-ag95-sim", "panda-ag95-sim"] {
        let file = format!("robots/{robot}.toml");
        let attempt = Attempt::new(&["--robot", &file]);
        assert_eq!(attempt.outcome["robot"], robot);
        // A verdict: whatever became of it, the world has judged it.
        assert!(attempt.outcome["success"].is_boolean(), "{}", attempt.call.stdout);
        assert!(
            attempt
                .stage("plan")
                .is_some_and(|plan| plan["reason"].is_null() || plan["ok"] == false)
        );
    }
}

#[test]
fn a_skill_and_a_robot_that_were_begun_are_sound_and_run() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let skill = ["new", "skill", "my-skill", "--folder", &path("skills")];
    let urdf = path("arm.urdf");
    fs::copy(root().join("robots/ur5e-ag95.urdf"), &urdf).expect("a URDF");
    let robot = ["new", "robot", "my-arm", "--urdf", &urdf, "--folder", &path("robots")];
    for words in [&skill[..], &robot[..]] {
        let made = seeone(words);
        assert_eq!(made.status, Some(0), "{}", made.stderr);
        let again = seeone(words);
        assert_eq!(again.status, Some(2), "{}", again.stderr);
        assert!(again.stderr.contains("error[G002]"), "{}", again.stderr);
    }
    let (skill, robot) = (path("skills/my-skill.toml"), path("robots/my-arm.toml"));
    let scene = "scenes/head.toml";
    let checked = seeone(["check", &skill, &robot, "--robot", &robot, "--scene", scene]);
    assert_eq!(checked.status, Some(0), "{}", checked.stderr);
    let dry = ["run", &skill, "--robot", &robot, "--dry-run", "--json", "--out", &path("out")];
    let planned = seeone(dry);
    assert_eq!(planned.status, Some(0), "{}", planned.stderr);
    let told: Value = serde_json::from_str(&planned.stdout).expect("one JSON object");
    assert_eq!((&told["skill"], &told["robot"]), (&"my-skill".into(), &"my-arm".into()));
    let ours = fs::read_to_string(root().join("robots/ur5e-ag95-sim.toml")).expect("a file");
    let theirs = fs::read_to_string(&robot).expect("a file");
    let pairs = |text: &str| text.split_once("[collision]").map(|(_, pairs)| pairs.to_owned());
    assert_eq!(pairs(&ours), pairs(&theirs), "sampled as the shipped file has them");
    let none =
        seeone(["new", "robot", "other", "--urdf", "README.md", "--folder", &path("robots")]);
    assert_eq!(none.status, Some(2), "{}", none.stderr);
    assert!(none.stderr.contains("error[R002]"), "{}", none.stderr);
    let named = seeone(["new", "skill", "My Skill", "--folder", &path("skills")]);
    assert!(named.stderr.contains("error[G001]"), "{}", named.stderr);
}

#[test]
fn a_cap_made_by_others_is_imported_and_tried() {
    let mesh = root().join("../shared/objects/baseball_cap_danlyvostok.obj");
    let Ok(mesh) = mesh.canonicalize() else {
        eprintln!("skipped: the imported cap is not beside this repository");
        return;
    };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let object = folder.path().join("baseball.toml").display().to_string();
    let mesh = mesh.display().to_string();
    let words = ["--up", "+y", "--head-circumference", "0.57", "--out", &object];
    let imported = seeone(["objects", "import", &mesh].into_iter().chain(words));
    assert_eq!(imported.status, Some(0), "{}", imported.stderr);
    let checked = seeone(["check", &object]);
    assert_eq!(checked.status, Some(0), "{}", checked.stderr);
    let attempt = Attempt::new(&["--object", &object]);
    assert_eq!(attempt.outcome["object"], "baseball_cap_danlyvostok");
    assert!(attempt.stage("perceive").is_some_and(|stage| stage["ok"] == true));
    let set = folder.path().join("set").display().to_string();
    // A drop that comes to rest and can be gripped.
    let data =
        ["data", "--objects", &object, "--frames", "9", "--seed", "2", "--out", &set, "--json"];
    let made = seeone(data);
    assert_eq!(made.status, Some(0), "{}", made.stderr);
    let made: Value = serde_json::from_str(&made.stdout).expect("one JSON object");
    let count = |moment: &str| made[moment].as_u64().expect("a count");
    assert_eq!(count("falling") + count("resting") + count("held"), 9, "{made}");
    assert!(count("held") > 0, "{made}");
}

#[test]
fn an_evaluation_does_not_depend_on_its_jobs() {
    let evaluated = |jobs: &str| {
        let call = seeone(["eval", SKILL, "--attempts", "2", "--jobs", jobs, "--json"]);
        assert_eq!(call.status, Some(0), "{}", call.stderr);
        let mut report: Value = serde_json::from_str(&call.stdout).expect("one JSON object");
        let attempts = report["attempts"].as_array_mut().expect("attempts");
        attempts.iter_mut().for_each(|attempt| *attempt = timeless(attempt));
        report
    };
    let (one, two) = (evaluated("1"), evaluated("2"));
    assert_eq!(one, two);
    assert_eq!(one["grasped"]["attempts"], 2);
    assert_eq!(one["attempts"][0]["seed"], 0);
    assert_eq!(one["attempts"][1]["seed"], 1);
    assert_ne!(one["attempts"][0]["object"], one["attempts"][1]["object"]);
}

/// The truth finds the grasp, and what is made worse is told. No oracle is asked for in a run.
#[test]
fn grasps_are_held_against_the_experts() {
    let evaluated = |extra: &[&str]| -> Value {
        let words = ["eval", "grasps", SKILL, "--objects", "train", "--attempts", "2", "--json"];
        let call = seeone(words.iter().chain(extra));
        assert_eq!(call.status, Some(0), "{extra:?}: {}", call.stderr);
        serde_json::from_str(&call.stdout).expect("one JSON object")
    };
    let told = evaluated(&["--oracle", "coordinates", "--oracle", "grasp"]);
    assert_eq!(told["near"]["successes"], 2, "{told}");
    let median = told["median"]["metres"].as_f64().expect("a median");
    assert!(median < 0.005, "{median}");
    let grasps = |extra: &[&str]| evaluated(extra)["grasps"].clone();
    let plain = grasps(&[]);
    assert_ne!(grasps(&["--camera-noise", "2", "--outliers", "0.05"]), plain);
    assert_ne!(grasps(&["--head-moves", "0.15", "--head-turns", "30"]), plain);
    for (words, cause) in [
        (["--oracle", "release"], "coordinates, grasp"),
        (["--outliers", "1.5"], "a number from 0 to 1"),
        (["--head-moves", "nan"], "a number from 0 to 1"),
    ] {
        let call = seeone(["eval", SKILL].iter().chain(&words));
        assert_eq!(call.status, Some(2), "{words:?}: {}", call.stderr);
        assert!(call.stderr.contains(cause), "{words:?}: {}", call.stderr);
    }
    let run = seeone(["run", SKILL, "--oracle", "grasp"]);
    assert_eq!(run.status, Some(2), "{}", run.stderr);
}

#[test]
fn a_skill_that_was_taught_is_sound() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let skill = folder.path().join("shown.toml").display().to_string();
    let taught = seeone(["teach", &skill]);
    assert_eq!(taught.status, Some(0), "{}", taught.stderr);
    let checked = seeone(["check", &skill]);
    assert_eq!(checked.status, Some(0), "{}", checked.stderr);
    let text = fs::read_to_string(&skill).expect("the skill");
    assert!(text.contains("cloud = \"shown/demonstration.ply\""), "{text}");
    let nameless = seeone(["teach", &skill.replace("shown", "Shown_1")]);
    assert_eq!(nameless.status, Some(2), "{}", nameless.stderr);
    assert!(nameless.stderr.contains("error[S021]: "), "{}", nameless.stderr);
}

#[test]
fn hanging_is_taught_where_there_is_a_hook() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let skill = folder.path().join("hung.toml").display().to_string();
    let nowhere = seeone(["teach", &skill, "--show", "hanging"]);
    assert_eq!(nowhere.status, Some(2), "{}", nowhere.stderr);
    assert!(nowhere.stderr.contains("error[M005]: scene \"head\" has no hook"));
    let taught = seeone(["teach", &skill, "--show", "hanging", "--scene", "scenes/hook.toml"]);
    assert_eq!(taught.status, Some(0), "{}", taught.stderr);
    let checked = seeone(["check", &skill]);
    assert_eq!(checked.status, Some(0), "{}", checked.stderr);
    let text = fs::read_to_string(&skill).expect("the skill");
    assert!(text.contains("measure = \"hung\"") && text.contains("frames.hook = "), "{text}");
}

#[test]
fn what_there_is_can_be_asked() {
    let plugins = seeone(["plugins", "list", "--json"]);
    let rows: Value = serde_json::from_str(&plugins.stdout).expect("JSON");
    let rows = rows.as_array().expect("an array");
    assert_eq!(rows.len(), 8);
    assert!(rows.iter().all(|row| !row["plugins"].as_array().expect("names").is_empty()));
    let objects = seeone(["objects", "list", "--json"]);
    let written = include_str!("../scenes/objects/caps.json");
    assert!(objects.stdout == written, "scenes/objects/caps.json is not what `objects list` says");
    let entries: Vec<Value> = serde_json::from_str(&objects.stdout).expect("entries");
    assert_eq!(entries.len(), seeone(["objects", "list"]).stdout.lines().count());
    let folder = tempfile::tempdir().expect("a temporary folder");
    for template in ["baseball", "bucket", "visor", "flat", "beanie"] {
        let entry = entries.iter().find(|e| e["template"] == template).expect("one of each");
        let name = entry["name"].as_str().expect("a name");
        let picture = folder.path().join("made").join(format!("{name}.png"));
        let shown = seeone(["objects", "show", name, "--out", &picture.display().to_string()]);
        assert_eq!(shown.status, Some(0), "{}", shown.stderr);
        assert!(fs::read(picture).expect("a picture").starts_with(b"\x89PNG"));
    }
    for kind in ["skill", "task", "scene", "robot"] {
        let path = root().join(format!("docs/schemas/{kind}.json"));
        let committed = fs::read_to_string(path).expect("a schema");
        assert_eq!(seeone(["schema", kind]).stdout, committed, "{kind}");
    }
    let unknown = seeone(["schema", "skil"]);
    assert_eq!(unknown.status, Some(2), "{}", unknown.stderr);
    for words in [["--help"], ["--version"]] {
        let call = seeone(words);
        assert_eq!((call.status, call.stderr.as_str()), (Some(0), ""));
    }
}

#[test]
fn a_reader_who_leaves_is_no_fault() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_seeone"))
        .args(["objects", "list"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the binary starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}
