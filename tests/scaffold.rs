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

fn ok(words: &[&str]) -> Call {
    let call = seeone(words);
    assert_eq!(call.status, Some(0), "{words:?}: {}", call.stderr);
    call
}

#[test]
fn a_new_plugin_of_every_kind_passes_its_tests_and_serves() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let target = Path::new(env!("CARGO_BIN_EXE_seeone")).ancestors().nth(2).expect("a folder");
    for kind in Kind::ALL {
        let name = format!("my-{kind}");
        let made = folder.path().join(&name);
        let out = made.display().to_string();
        let call = ok(&["new", "plugin", "--kind", kind.name(), &name, "--out", &out]);
        assert!(call.stderr.contains("seeone plugins trust"), "{}", call.stderr);
        cargo("test", &made);
        cargo("build", &made);
        let library = format!(
            "{}{}{}",
            std::env::consts::DLL_PREFIX,
            name.replace('-', "_"),
            std::env::consts::DLL_SUFFIX
        );
        let library = target.join("scaffold/release").join(library).display().to_string();
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
