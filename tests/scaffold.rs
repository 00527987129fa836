//! What `new plugin` makes builds, passes its own tests untouched, and changes a run.

mod support;

use seeone_plugin::Kind;
use serde_json::Value;
use std::path::Path;
use std::process::Command;
use support::{Call, root, seeone};

const SKILL: &str = "skills/cap-wearing.toml";

/// Calls cargo for the crate at `folder`, with one target folder for all.
fn cargo(verb: &str, folder: &Path) {
    let target = Path::new(env!("CARGO_BIN_EXE_seeone")).ancestors().nth(2).expect("a folder");
    let output = Command::new(env!("CARGO"))
        .args([verb, "--release", "--quiet"])
        .current_dir(folder)
        .env("CARGO_TARGET_DIR", target.join("scaffold"))
        .output()
        .expect("cargo starts");
    let told = String::from_utf8_lossy(&output.stderr);
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "cargo {verb} in {}: {told}{said}", folder.display());
    assert!(!told.contains("warning"), "cargo {verb} in {}: {told}", folder.display());
}

/// The library of the crate `name` in that target folder.
fn library(name: &str) -> String {
    let target = Path::new(env!("CARGO_BIN_EXE_seeone")).ancestors().nth(2).expect("a folder");
    let (prefix, suffix) = (std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let file = format!("{prefix}{}{suffix}", name.replace('-', "_"));
    target.join("scaffold/release").join(file).display().to_string()
}

fn ok(words: &[&str]) -> Call {
    let call = seeone(words);
    assert_eq!(call.status, Some(0), "{words:?}: {}", call.stderr);
    call
}

#[test]
fn a_new_plugin_of_every_kind_passes_its_tests_and_serves() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for kind in Kind::ALL {
        let name = format!("my-{kind}");
        let made = folder.path().join(&name);
        let out = made.display().to_string();
        let call = ok(&["new", "plugin", "--kind", kind.name(), &name, "--out", &out]);
        assert!(call.stderr.contains("seeone plugins trust"), "{}", call.stderr);
        cargo("test", &made);
        cargo("build", &made);
        let library = library(&name);
        ok(&["plugins", "trust", &library]);
        let offered = ok(&["plugins", "check", &library]).stdout;
        assert!(offered.contains(&format!("{kind} \"{name}\" 0.1.0")), "{offered}");
        assert!(offered.contains("\ntrusted"), "{offered}");

        // It plans, as the linked plugin of its kind would, and the run says that it did.
        let records = folder.path().join("out").display().to_string();
        let method = format!("{kind}={name}");
        let mut words = vec!["run", SKILL, "--dry-run", "--json", "--out", &records];
        words.extend(["--plugin", &library, "--method", &method]);
        let run = seeone(&words);
        assert!(matches!(run.status, Some(0 | 1)), "{kind}: {}", run.stderr);
        let outcome: Value = serde_json::from_str(&run.stdout).expect("one JSON object");
        assert_eq!(outcome["methods"][kind.name()], name, "{kind}");
        let reason = outcome["reason"].as_str().expect("a reason");
        assert!(!reason.contains("internal fault"), "{kind}: {reason}");
    }
}

/// The guide in CONTRIBUTING.md with the change that it names: what was planned differs.
#[test]
fn a_changed_plugin_is_refused_until_it_is_trusted_and_then_changes_what_is_planned() {
    let guide = std::fs::read_to_string(root().join("CONTRIBUTING.md")).expect("the guide");
    let (before, after) = ("steps: 15", "steps: 60");
    assert!(guide.contains(&format!("sed -i 's/{before}/{after}/' ../my-search/src/lib.rs")));
    let folder = tempfile::tempdir().expect("a temporary folder");
    let made = folder.path().join("my-search");
    let out = made.display().to_string();
    ok(&["new", "plugin", "--kind", "transfer", "my-search", "--out", &out]);
    cargo("build", &made);
    let library = library("my-search");
    ok(&["plugins", "trust", &library]);
    let records = folder.path().join("out");
    let at = records.display().to_string();
    let method = "transfer=my-search";
    let words = ["run", SKILL, "--dry-run", "--out", &at, "--plugin", &library, "--method", method];
    let planned = || {
        ok(&words);
        let files = std::fs::read_dir(&records).expect("the records");
        let mut paths = files.map(|file| file.expect("a record").path());
        let table = paths.find(|path| path.extension().is_some_and(|end| end == "csv"));
        std::fs::read(table.expect("a table of the planned motion")).expect("the table")
    };
    let first = planned();
    assert_eq!(planned(), first, "the same plugin plans the same");

    let source = made.join("src/lib.rs");
    let text = std::fs::read_to_string(&source).expect("the source");
    assert!(text.contains(before));
    std::fs::write(&source, text.replace(before, after)).expect("written");
    cargo("test", &made);
    cargo("build", &made);
    let refused = seeone(words);
    assert_eq!(refused.status, Some(2), "{}", refused.stderr);
    assert!(refused.stderr.contains("plugins trust"), "{}", refused.stderr);
    ok(&["plugins", "trust", &library]);
    assert_ne!(planned(), first, "what looks closer finds another place");
}

#[test]
fn what_cannot_be_made_is_told() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let there = folder.path().display().to_string();
    let refused = |words: &[&str], code: &str| {
        let call = seeone(["new", "plugin", "--kind", "transfer"].iter().chain(words));
        assert_eq!(call.status, Some(2), "{words:?}: {}", call.stderr);
        assert!(call.stderr.contains(code), "{words:?}: {}", call.stderr);
    };
    refused(&["My Search"], "G001");
    refused(&["my-search", "--out", &there], "G002");
    refused(&["my-search", "--framework", &there], "G003");
    assert!(!root().join("my-search").exists());
    let unknown = seeone(["new", "plugin", "--kind", "transfur", "x"]);
    assert_eq!(unknown.status, Some(2));
    assert!(unknown.stderr.contains("not one of camera, perception"), "{}", unknown.stderr);
}
