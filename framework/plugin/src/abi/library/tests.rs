//! Tables that must be refused, and plugins that misbehave behind a sound one.

use super::super::export::{ExportedAlignment, alignment_table};
use super::*;
use crate::{AlignmentOutcome, Correspondences};
use nalgebra::Point3;
use seeone_core::Similarity;

/// A plugin that does what its table of the configuration says.
enum Fake {
    Answers(f64),
    Panics,
}

impl Alignment for Fake {
    fn align(&self, pairs: &Correspondences) -> Result<AlignmentOutcome, PluginError> {
        match self {
            Fake::Answers(scale) => {
                pairs.check()?;
                let transform = Similarity::from_scaling(*scale);
                let residual = if *scale == 13.0 { f64::NAN } else { 0.1 };
                Ok(AlignmentOutcome { transform, residual, inlier_share: 0.5, condition: 1.0 })
            }
            Fake::Panics => panic!("as told, with {} pairs", pairs.source.len()),
        }
    }
}

struct Exported;

impl ExportedAlignment for Exported {
    const NAME: &'static str = "fake";
    const VERSION: &'static str = "1.2.3";

    fn construct(setup: &Setup) -> Result<Box<dyn Alignment>, PluginError> {
        Ok(Box::new(match setup.config.get("do").and_then(toml::Value::as_str) {
            Some("panic") => Fake::Panics,
            Some("panic at once") => panic!("while it was built"),
            Some(other) => return Err(PluginError::Configuration(format!("do {other}?"))),
            None => Fake::Answers(setup.seed as f64),
        }))
    }
}

fn sound() -> AlignmentTable {
    alignment_table::<Exported>()
}

/// Reads a table as it would be read from a library.
fn served(made: AlignmentTable) -> Result<Loaded, Diagnostic> {
    let header = &raw const Box::leak(Box::new(made)).header;
    // SAFETY: a whole table that lives for good.
    unsafe { table(header) }
}

/// Why a table that `spoil` altered is refused.
fn refusal(spoil: impl Fn(&mut AlignmentTable)) -> String {
    let mut table = sound();
    spoil(&mut table);
    match served(table) {
        Err(told) => told.to_string(),
        Ok(loaded) => panic!("{} was served", loaded.name),
    }
}

fn loaded(config: &str, seed: u64) -> Result<LoadedAlignment, PluginError> {
    let table = served(sound()).expect("sound").table;
    let config = config.parse().expect("TOML");
    LoadedAlignment::new(
        table,
        &Setup { config: &config, root: Path::new("."), seed, world: None, robot: None },
    )
}

fn align(plugin: &LoadedAlignment) -> Result<AlignmentOutcome, PluginError> {
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point3::from);
    let pairs =
        Correspondences { source: &points, target: &points, weights: &[1.0; 3], fixed_scale: None };
    plugin.align(&pairs)
}

#[test]
fn a_sound_table_is_served() {
    let loaded = served(sound()).expect("sound");
    assert_eq!((loaded.name.as_str(), loaded.version.as_str()), ("fake", "1.2.3"));
    assert_eq!((loaded.kind, loaded.abi), (Kind::Alignment, (1, 0)));
}

#[test]
fn a_newer_table_with_more_at_its_end_is_served() {
    let mut newer = sound();
    newer.header.abi_minor = 4;
    newer.header.size += 16;
    assert_eq!(served(newer).expect("appended").abi, (1, 4));
}

#[test]
fn tables_of_others_are_refused() {
    assert!(refusal(|t| t.header.magic ^= 1).starts_with("error[L007]"));
    assert!(refusal(|t| t.header.abi_major += 1).contains("has ABI 2.0, this host 1.0"));
    assert!(refusal(|t| t.header.size -= 8).starts_with("error[L009]"));
    assert!(refusal(|t| t.header.kind = 99).contains("unknown kind 99"));
    assert!(refusal(|t| t.align = None).contains("a function of the table is missing"));
    assert!(refusal(|t| t.release = None).contains("a function of the table is missing"));
    assert!(refusal(|t| t.header.name = Span::of(b"")).starts_with("error[L009]"));
    assert!(refusal(|t| t.header.name = Span::of(b"\xff\xfe")).starts_with("error[L009]"));
    assert!(refusal(|t| t.header.version = Span::of(&[b'1'; 300])).starts_with("error[L009]"));
    // SAFETY: null is allowed.
    let none = unsafe { table(std::ptr::null()) };
    assert!(none.is_err_and(|told| told.code == "L007"));
}

#[test]
fn answers_and_refusals_cross() {
    let found = align(&loaded("", 3).expect("built")).expect("answered");
    assert_eq!(found.transform, Similarity::from_scaling(3.0));
    assert_eq!((found.residual, found.inlier_share, found.condition), (0.1, 0.5, 1.0));
    let told = loaded("do = 'nothing'", 3).expect_err("refused");
    assert_eq!(told, PluginError::Configuration("do nothing?".into()));
}

#[test]
fn a_panic_is_an_error_and_the_host_goes_on() {
    let plugin = loaded("do = 'panic'", 3).expect("built");
    let told = "the plugin panicked: as told, with 3 pairs";
    assert_eq!(align(&plugin), Err(PluginError::Internal(told.into())));
    assert_eq!(align(&plugin), Err(PluginError::Internal(told.into())));
    let told = loaded("do = 'panic at once'", 3).expect_err("refused").to_string();
    assert!(told.contains("while it was built"), "{told}");
}

#[test]
fn nonsense_is_not_believed() {
    let told = align(&loaded("", 13).expect("built")).expect_err("a residual of NaN");
    assert!(told.to_string().contains("nonsense"), "{told}");
}

#[test]
fn what_is_no_library_is_told_with_the_loader_s_own_words() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("libtext.so");
    fs::write(&path, "not a library").expect("written");
    let told = Manifest::write_for(&path).expect_err("no library").to_string();
    assert!(told.starts_with("error[L005]") && told.contains("libtext.so"), "{told}");
    assert!(
        told.contains("ELF") || told.contains("header") || told.contains("too short"),
        "{told}"
    );
    let told = Library::open(&path).expect_err("no manifest").to_string();
    assert!(told.starts_with("error[L001]") && told.contains("plugins trust"), "{told}");
}
