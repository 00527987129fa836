//! The same plugin served from a dynamic library: same rules, same bits, and no damaged
//! library is ever loaded.

use nalgebra::{Point3, UnitQuaternion, Vector3};
use seeone_core::Similarity;
use seeone_core::random::{generator, normal};
use seeone_plugin::abi::{Library, LoadedPlugin, Manifest};
use seeone_plugin::conformance::alignment::bits;
use seeone_plugin::{Alignment, Correspondences, Kind, PluginError, Setup, conformance};
use seeone_procrustes::Procrustes;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// The library as built beside this test. `cargo test` builds examples with the tests
/// unless it is told otherwise; then it is built here.
fn built() -> PathBuf {
    let test = std::env::current_exe().expect("a running test has a path");
    let target = test.ancestors().nth(2).expect("tests lie in PROFILE/deps").to_owned();
    let name =
        format!("{}procrustes{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let path = target.join("examples").join(name);
    if !path.exists() {
        let profile = if cfg!(debug_assertions) { "dev" } else { "release" };
        let status = Command::new(env!("CARGO"))
            .current_dir(env!("CARGO_MANIFEST_DIR"))
            .args(["build", "--example", "procrustes", "--profile", profile, "--target-dir"])
            .arg(target.parent().expect("PROFILE lies in the target folder"))
            .status();
        assert!(status.is_ok_and(|s| s.success()), "the library could not be built");
    }
    path
}

/// A copy of the library in its own folder, so that each test may damage its own.
fn copied() -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("libprocrustes.so");
    fs::copy(built(), &path).expect("copied");
    (folder, path)
}

fn trusted() -> (tempfile::TempDir, PathBuf) {
    let (folder, path) = copied();
    Manifest::write_for(&path).expect("a sound library");
    (folder, path)
}

fn setup(config: &toml::Table) -> Setup<'_> {
    Setup { config, root: Path::new("."), seed: 5, world: None, robot: None }
}

/// Puts other bytes in the library's place, as a new file: the old one stays mapped into
/// this process, and writing into that would end it.
fn replace(path: &Path, bytes: &[u8]) {
    fs::remove_file(path).expect("there");
    fs::write(path, bytes).expect("written");
}

/// The plugin of this name, from the library at `path`.
fn loaded(path: &Path, name: &str, setup: &Setup) -> Result<LoadedPlugin, PluginError> {
    let library = Library::open(path).expect("trusted");
    let offer = library.offers().iter().find(|offer| offer.id.name == name);
    offer.expect("offered").build(setup, Some(Duration::from_secs(60)))
}

/// Why the library at `path` is refused.
fn refusal(path: &Path) -> String {
    Library::open(path).expect_err("must be refused").to_string()
}

#[test]
fn the_loaded_plugin_conforms() {
    let (_folder, path) = trusted();
    for name in ["procrustes", "ransac"] {
        let plugin = loaded(&path, name, &setup(&toml::Table::new())).expect("defaults");
        conformance::alignment(&plugin).expect("conforms");
    }
}

#[test]
fn loaded_and_linked_agree_to_the_bit() {
    let (_folder, path) = trusted();
    let config = "tuning = 2.5".parse().expect("TOML");
    let loaded = loaded(&path, "procrustes", &setup(&config)).expect("valid");
    let linked = Procrustes::from_setup(&setup(&config)).expect("valid");
    let mut rng = generator(11, "pairs");
    for round in 0..50 {
        let mut draw = || Vector3::from_fn(|_, _| normal(&mut rng));
        let rotation = UnitQuaternion::new(draw());
        let truth = Similarity::from_parts(draw().into(), rotation, 0.3);
        let source: Vec<_> = (0..64).map(|_| Point3::from(draw())).collect();
        let target: Vec<_> = source.iter().map(|p| truth * p + 0.02 * draw()).collect();
        let weights: Vec<f64> = (0..64).map(|_| draw().x.abs()).collect();
        let fixed_scale = (round % 2 == 0).then_some(0.29);
        let pairs =
            Correspondences { source: &source, target: &target, weights: &weights, fixed_scale };
        let (a, b) = (linked.align(&pairs), loaded.align(&pairs));
        assert_eq!(bits(&a.expect("solvable")), bits(&b.expect("solvable")), "round {round}");
    }
}

#[test]
fn a_wrong_table_is_refused_through_the_library_as_when_linked() {
    let (_folder, path) = trusted();
    let config = "tuning = -1.0".parse().expect("TOML");
    let linked = Procrustes::from_setup(&setup(&config)).expect_err("refused");
    let loaded = loaded(&path, "procrustes", &setup(&config)).expect_err("refused");
    assert_eq!(linked, loaded);
    assert!(matches!(loaded, PluginError::Configuration(_)));
}

#[test]
fn the_manifest_says_what_is_trusted() {
    let (_folder, path) = trusted();
    let manifest = Manifest::read_for(&path).expect("written");
    let names: Vec<&str> = manifest.plugins.iter().map(|plugin| plugin.name.as_str()).collect();
    assert_eq!(names, ["procrustes", "ransac"]);
    for plugin in &manifest.plugins {
        assert_eq!(
            (plugin.kind, plugin.version.as_str()),
            (Kind::Alignment, env!("CARGO_PKG_VERSION"))
        );
    }
    assert_eq!(manifest.size_bytes, fs::metadata(&path).expect("there").len());
    assert_eq!(Library::open(&path).expect("trusted").manifest(), &manifest);
}

#[test]
fn an_untrusted_library_is_refused() {
    let (_folder, path) = copied();
    let told = refusal(&path);
    assert!(told.starts_with("error[L001]") && told.contains("plugins trust"), "{told}");
}

#[test]
fn a_truncated_or_grown_library_is_refused() {
    let (_folder, path) = trusted();
    let whole = fs::read(&path).expect("there");
    for part in 0..64 {
        let kept = whole.len() * part / 64;
        replace(&path, &whole[..kept]);
        let told = refusal(&path);
        assert!(told.starts_with("error[L003]") && told.contains(&kept.to_string()), "{told}");
    }
    replace(&path, &[whole.as_slice(), b"!"].concat());
    assert!(refusal(&path).starts_with("error[L003]"));
}

#[test]
fn a_flipped_bit_is_refused_wherever_it_is() {
    let (_folder, path) = trusted();
    let whole = fs::read(&path).expect("there");
    for at in (0..whole.len()).step_by(whole.len() / 64) {
        let mut damaged = whole.clone();
        damaged[at] ^= 0x10;
        replace(&path, &damaged);
        let told = refusal(&path);
        assert!(told.starts_with("error[L004]") && told.contains("BLAKE3"), "{told}");
    }
}

#[test]
fn a_damaged_manifest_is_refused_with_its_place() {
    let (_folder, path) = trusted();
    let manifest = Manifest::path_for(&path);
    let text = fs::read_to_string(&manifest).expect("written");
    for (from, to, told) in [
        ("alignment", "alchemy", "no plugin kind \"alchemy\""),
        ("schema = 2", "schema = 3", "schema is 3"),
        ("schema = 2", "schema = 2\nextra = 1", "libprocrustes.so.toml:2:1"),
        ("blake3 = \"", "blake3 = \"zz", "64 hexadecimal digits"),
        ("size_bytes", "size", "size"),
    ] {
        assert!(text.contains(from), "{text}");
        fs::write(&manifest, text.replace(from, to)).expect("written");
        let refused = refusal(&path);
        assert!(refused.starts_with("error[L002]") && refused.contains(told), "{refused}");
    }
    fs::write(&manifest, text.replace("\"procrustes\"", "\"another\"")).expect("written");
    assert!(refusal(&path).starts_with("error[L011]"));
}
