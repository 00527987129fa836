//! The invariants of absence that ARCHITECTURE.md states, checked on the sources.

use std::fs;
use std::path::{Path, PathBuf};

/// The measured hot kernel: matrix products, whose library takes pointers.
const HOT_KERNEL: &str = "framework/nn/src/matmul.rs";
/// The library that writes tensors takes their notes as a map; there is one note.
const ONE_NOTE: (&str, &str) = ("framework/nn/src/checkpoint.rs", "HashMap");
const PLUGIN_PREFIX: &str = "plugins/";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the workspace")
}

fn manifests() -> Vec<(String, toml::Table)> {
    let mut found = Vec::new();
    for room in ["framework", "plugins"] {
        let mut crates: Vec<PathBuf> = fs::read_dir(root().join(room))
            .expect("a room")
            .map(|entry| entry.expect("an entry").path())
            .filter(|path| path.join("Cargo.toml").exists())
            .collect();
        crates.sort();
        for path in crates {
            let text = fs::read_to_string(path.join("Cargo.toml")).expect("a manifest");
            let name = path.file_name().expect("a name").to_string_lossy().into_owned();
            found.push((format!("{room}/{name}"), text.parse().expect("valid TOML")));
        }
    }
    assert!(found.len() > 10, "the rooms were found");
    found
}

fn dependencies(manifest: &toml::Table) -> Vec<String> {
    let table = manifest.get("dependencies").and_then(toml::Value::as_table);
    table.map(|table| table.keys().cloned().collect()).unwrap_or_default()
}

fn package_name(manifest: &toml::Table) -> String {
    manifest["package"]["name"].as_str().expect("a name").to_owned()
}

fn sources(folder: &Path, into: &mut Vec<PathBuf>) {
    let mut entries: Vec<PathBuf> =
        fs::read_dir(folder).expect("a folder").map(|e| e.expect("an entry").path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            sources(&path, into);
        } else if path.extension().is_some_and(|e| e == "rs") {
            into.push(path);
        }
    }
}

fn all_sources() -> Vec<(String, String)> {
    let mut paths = Vec::new();
    for room in ["framework", "plugins"] {
        sources(&root().join(room), &mut paths);
    }
    paths
        .into_iter()
        .filter(|path| !path.components().any(|c| c.as_os_str() == "target"))
        .map(|path| {
            let text = fs::read_to_string(&path).expect("a source");
            let name = path.strip_prefix(root()).expect("inside").display().to_string();
            (name, text)
        })
        .collect()
}

#[test]
fn the_framework_names_no_plugin_except_in_the_binary() {
    let manifests = manifests();
    let plugins: Vec<String> = manifests
        .iter()
        .filter(|(path, _)| path.starts_with(PLUGIN_PREFIX))
        .map(|(_, manifest)| package_name(manifest))
        .collect();
    for (path, manifest) in &manifests {
        if path.starts_with("framework/") && path != "framework/cli" {
            for dependency in dependencies(manifest) {
                assert!(!plugins.contains(&dependency), "{path} depends on {dependency}");
            }
        }
    }
}

#[test]
fn no_plugin_depends_on_another_or_on_the_runtime() {
    let allowed = ["seeone-core", "seeone-plugin", "seeone-collision", "seeone-nn", "seeone-sim"];
    for (path, manifest) in manifests() {
        if !path.starts_with(PLUGIN_PREFIX) {
            continue;
        }
        // A dynamic library's crate is its plugin and the export, nothing more.
        let own = format!("{}-dylib", path.trim_end_matches("-dylib"));
        let wraps = (own == path).then(|| package_name(&manifest).replace("-dylib", ""));
        for dependency in dependencies(&manifest) {
            let ours = dependency.starts_with("seeone");
            assert!(
                !ours
                    || allowed.contains(&dependency.as_str())
                    || Some(&dependency) == wraps.as_ref(),
                "{path} depends on {dependency}"
            );
        }
    }
}

#[test]
fn core_knows_neither_ecs_nor_tensors_nor_physics() {
    for (path, manifest) in manifests() {
        if path == "framework/core" {
            for dependency in dependencies(&manifest) {
                let foreign = ["bevy", "candle", "rapier", "parry", "seeone"];
                assert!(!foreign.iter().any(|f| dependency.starts_with(f)), "core: {dependency}");
            }
        }
    }
}

#[test]
fn unsafe_code_lives_in_the_abi_module_and_one_kernel_alone() {
    for (path, text) in all_sources() {
        let lifted = text.contains("allow(unsafe_code") || text.contains("expect(unsafe_code");
        let abi = path.starts_with("framework/plugin/src/abi") || path.contains("-dylib/");
        assert!(!lifted || abi || path == HOT_KERNEL, "{path} lifts the ban on unsafe code");
    }
}

#[test]
fn no_plugin_sees_the_ecs_world() {
    for (path, manifest) in manifests() {
        if path.starts_with(PLUGIN_PREFIX) || path == "framework/plugin" {
            assert!(!dependencies(&manifest).iter().any(|d| d.starts_with("bevy")), "{path}");
        }
    }
}

#[test]
fn a_seeded_run_reads_no_clock_and_no_hash_order() {
    for (path, text) in all_sources() {
        // The binary may time its stages and show progress; tests may do as they like, and so
        // may the suite that plugins are tested with.
        if path.starts_with("framework/cli/")
            || path.starts_with("framework/plugin/src/conformance/")
            || path.contains("/tests/")
            || path.contains("/benches/")
            || path.contains("/examples/")
        {
            continue;
        }
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        for word in
            ["Instant::now", "SystemTime::now", "thread_rng", "rand::rng(", "HashMap", "HashSet"]
        {
            let used = code.lines().any(|l| !l.trim_start().starts_with("//") && l.contains(word));
            assert!(!used || (path.as_str(), word) == ONE_NOTE, "{path} uses {word}");
        }
    }
}

#[test]
fn robots_and_skills_do_not_name_each_other() {
    let names = |folder: &str, key: &str| -> Vec<(String, String)> {
        fs::read_dir(root().join(folder))
            .expect("a folder")
            .map(|entry| entry.expect("an entry").path())
            .filter(|path| path.extension().is_some_and(|e| e == "toml"))
            .map(|path| {
                let text = fs::read_to_string(&path).expect("a file");
                let table: toml::Table = text.parse().expect("valid TOML");
                let name = table.get(key).and_then(toml::Value::as_str).unwrap_or_default();
                (name.to_owned(), text)
            })
            .collect()
    };
    let (mut skills, robots) = (names("skills", "name"), names("robots", "name"));
    skills.extend(names("skills/tasks", "name"));
    assert!(!skills.is_empty() && !robots.is_empty());
    for (skill, skill_text) in &skills {
        for (robot, robot_text) in &robots {
            assert!(!robot_text.contains(skill.as_str()), "robot {robot} names skill {skill}");
            assert!(!skill_text.contains(robot.as_str()), "skill {skill} names robot {robot}");
        }
        for joint in
            ["shoulder_pan", "shoulder_lift", "elbow_joint", "wrist_1", "wrist_2", "wrist_3"]
        {
            assert!(!skill_text.contains(joint), "skill {skill} names the joint {joint}");
        }
    }
}
