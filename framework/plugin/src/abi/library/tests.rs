//! Tables that must be refused, and plugins that misbehave behind a sound one.

use super::super::callee::{guarded, serve};
use super::super::cells::message;
use super::super::export::{Exported, Plugin, table as exported};
use super::super::message::Message;
use super::super::table::{Answer, Service, Status};
use super::*;
use crate::{Alignment, AlignmentOutcome, Correspondences};
use nalgebra::Point3;
use seeone_core::Similarity;
use std::ffi::c_void;
use std::sync::mpsc::channel;
use std::thread;

/// How long the tests wait for a plugin.
const PATIENCE: Duration = Duration::from_secs(2);

/// A plugin that does what its table of the configuration says.
enum Fake {
    Answers(f64),
    Panics,
    Hangs,
}

impl Alignment for Fake {
    fn align(&self, pairs: &Correspondences) -> Result<AlignmentOutcome, PluginError> {
        match self {
            Fake::Answers(scale) => {
                pairs.check()?;
                let transform = Similarity::from_scaling(*scale);
                let residual = match *scale {
                    13.0 => f64::NAN,
                    14.0 => f64::INFINITY,
                    _ => 0.1,
                };
                Ok(AlignmentOutcome { transform, residual, inlier_share: 0.5, condition: 1.0 })
            }
            Fake::Panics => panic!("as told, with {} pairs", pairs.source.len()),
            Fake::Hangs => {
                // A sender that is never used and never dropped.
                let (kept, silence) = channel::<()>();
                _ = silence.recv();
                drop(kept);
                Err(PluginError::Internal("the silence ended".into()))
            }
        }
    }
}

struct Sound;

impl Exported for Sound {
    const KIND: Kind = Kind::Alignment;
    const NAME: &'static str = "fake";
    const VERSION: &'static str = "1.2.3";

    fn construct(setup: &Setup) -> Result<Plugin, PluginError> {
        let fake = match setup.config.get("do").and_then(toml::Value::as_str) {
            Some("panic") => Fake::Panics,
            Some("hang") => Fake::Hangs,
            Some("panic at once") => panic!("while it was built"),
            Some("hang at once") => loop {
                thread::park();
            },
            Some(other) => return Err(PluginError::Configuration(format!("do {other}?"))),
            None => Fake::Answers(setup.seed as f64),
        };
        Ok(Plugin::Alignment(Box::new(fake)))
    }
}

fn sound() -> Table {
    exported::<Sound>()
}

/// Reads tables as they would be read from a library.
fn served(made: Vec<Table>) -> Result<Vec<Offer>, Diagnostic> {
    let tables: &'static [Table] = made.leak();
    let entry = |index: u32| {
        tables.get(index as usize).map_or(std::ptr::null(), |table| &raw const table.header)
    };
    // SAFETY: whole tables that live for good.
    unsafe { offers(entry) }
}

/// Why a table that `spoil` altered is refused.
fn refusal(spoil: impl Fn(&mut Table)) -> String {
    let mut table = sound();
    spoil(&mut table);
    match served(vec![table]) {
        Err(told) => told.to_string(),
        Ok(offers) => panic!("{} was served", offers[0].id),
    }
}

fn loaded(table: Table, config: &str, seed: u64) -> Result<LoadedPlugin, PluginError> {
    let offers = served(vec![table]).expect("sound");
    let config = config.parse().expect("TOML");
    let setup = Setup { config: &config, root: Path::new("."), seed, world: None, robot: None };
    offers[0].build(&setup, Some(PATIENCE))
}

fn align(plugin: &LoadedPlugin) -> Result<AlignmentOutcome, PluginError> {
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point3::from);
    let pairs =
        Correspondences { source: &points, target: &points, weights: &[1.0; 3], fixed_scale: None };
    plugin.align(&pairs)
}

/// What a plugin of `table` says to a question that it should answer; it names itself and the
/// entry.
fn fault(table: Table, config: &str, seed: u64) -> String {
    let told = align(&loaded(table, config, seed).expect("built")).expect_err("a fault");
    assert!(matches!(told, PluginError::Internal(_)), "{told:?}");
    let told = told.to_string();
    assert!(told.contains("alignment plugin \"fake\" in \"align\": "), "{told}");
    told
}

#[test]
fn a_sound_table_is_served() {
    let offers = served(vec![sound()]).expect("sound");
    assert_eq!(offers[0].id.to_string(), "alignment \"fake\" 1.2.3");
    assert_eq!(offers[0].abi, (3, 0));
}

#[test]
fn a_newer_table_with_more_at_its_end_is_served() {
    let mut newer = sound();
    newer.header.abi_minor = 4;
    newer.header.size += 16;
    assert_eq!(served(vec![newer]).expect("appended")[0].abi, (3, 4));
}

#[test]
fn a_shorter_table_is_refused_whatever_its_minor() {
    let told = refusal(|t| {
        t.header.abi_minor = 1;
        t.header.size -= 8;
    });
    assert!(told.starts_with("error[L009]") && told.contains("96 bytes"), "{told}");
}

#[test]
fn tables_of_others_are_refused() {
    assert!(refusal(|t| t.header.magic ^= 1).starts_with("error[L007]"));
    assert!(refusal(|t| t.header.abi_major += 1).contains("has ABI 4.0, this host 3.0"));
    assert!(refusal(|t| t.header.abi_major -= 1).contains("has ABI 2.0, this host 3.0"));
    assert!(refusal(|t| t.header.kind = 99).contains("unknown kind 99"));
    assert!(refusal(|t| t.create = None).contains("the function \"create\" of the table"));
    assert!(refusal(|t| t.call = None).contains("the function \"call\" of the table"));
    assert!(refusal(|t| t.release = None).contains("the function \"release\" of the table"));
    assert!(refusal(|t| t.header.name = Span::of(b"")).starts_with("error[L009]"));
    assert!(refusal(|t| t.header.name = Span::of(b"\xff\xfe")).starts_with("error[L009]"));
    assert!(refusal(|t| t.header.version = Span::of(&[b'1'; 300])).starts_with("error[L009]"));
    assert_eq!(served(Vec::new()).expect_err("none").code, "L007");
}

#[test]
fn a_name_twice_and_an_endless_list_are_refused() {
    let told = served(vec![sound(), sound()]).expect_err("twice").to_string();
    assert!(told.contains("L012") && told.contains("two alignment plugins \"fake\""), "{told}");
    let endless = (0..80usize).map(|i| {
        let mut table = sound();
        table.header.name = Span::of(format!("fake {i}").leak().as_bytes());
        table
    });
    let told = served(endless.collect()).expect_err("endless").to_string();
    assert!(told.contains("L007") && told.contains("goes on after"), "{told}");
}

#[test]
fn answers_and_refusals_cross() {
    let found = align(&loaded(sound(), "", 3).expect("built")).expect("answered");
    assert_eq!(found.transform, Similarity::from_scaling(3.0));
    assert_eq!((found.residual, found.inlier_share, found.condition), (0.1, 0.5, 1.0));
    let told = loaded(sound(), "do = 'nothing'", 3).expect_err("refused");
    assert_eq!(told, PluginError::Configuration("do nothing?".into()));
}

#[test]
fn without_patience_the_answers_are_the_same() {
    let offers = served(vec![sound()]).expect("sound");
    let config = toml::Table::new();
    let setup = Setup { config: &config, root: Path::new("."), seed: 3, world: None, robot: None };
    let direct = align(&offers[0].build(&setup, None).expect("built"));
    assert_eq!(direct, align(&loaded(sound(), "", 3).expect("built")));
}

#[test]
fn a_panic_is_an_error_and_the_host_goes_on() {
    let plugin = loaded(sound(), "do = 'panic'", 3).expect("built");
    for _ in 0..2 {
        let told = align(&plugin).expect_err("a panic").to_string();
        assert!(told.ends_with("in \"align\": a panic: as told, with 3 pairs"), "{told}");
    }
    let told = loaded(sound(), "do = 'panic at once'", 3).expect_err("refused").to_string();
    assert!(told.ends_with("in \"create\": a panic: while it was built"), "{told}");
}

#[test]
fn a_plugin_that_hangs_is_left_alone() {
    let plugin = loaded(sound(), "do = 'hang'", 3).expect("built");
    let told = align(&plugin).expect_err("a hang").to_string();
    assert!(told.ends_with("in \"align\": no sign of life for 2 s; it is left alone"), "{told}");
    let again = align(&plugin).expect_err("left alone").to_string();
    assert!(again.contains("left alone since it gave no answer"), "{again}");
    let told = loaded(sound(), "do = 'hang at once'", 3).expect_err("refused").to_string();
    assert!(told.contains("in \"create\": no sign of life"), "{told}");
}

#[test]
fn numbers_that_are_not_finite_are_not_believed() {
    for seed in [13, 14] {
        let told = fault(sound(), "", seed);
        assert!(told.contains("not to be believed: a number is out of its range"), "{told}");
    }
}

/// The cells of an outcome that moves nothing: pose, scale, residual, share, condition.
const UNMOVED: [f64; 11] = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 1.0];

/// A `call` that does `work` instead of a plugin's.
macro_rules! call {
    ($work:expr) => {{
        unsafe extern "C" fn call(
            _: *mut c_void,
            method: u64,
            request: Span<u64>,
            lent: Span<Service>,
            answer: *const Answer,
            message: *mut Message,
        ) -> Status {
            // SAFETY: the host's records are valid for the call.
            unsafe { serve(method, request, lent, answer, message, |_, _, _| $work) }
        }
        Table { call: Some(call), ..sound() }
    }};
}

#[test]
fn answers_of_a_wrong_length_are_not_believed() {
    let told = fault(call!(Ok(vec![0; 3])), "", 3);
    assert!(told.contains("a message is malformed: it ends where"), "{told}");
    let told = fault(call!(Ok(message(&[&UNMOVED, &0u64]))), "", 3);
    assert!(told.contains("1 cells are left over"), "{told}");
}

#[test]
fn an_error_without_a_text_gets_one() {
    let told = fault(call!(Err(PluginError::Internal("  ".into()))), "", 3);
    assert!(told.ends_with("it failed with status 4 and said nothing"), "{told}");
}

#[test]
fn success_without_an_answer_is_none() {
    unsafe extern "C" fn call(
        _: *mut c_void,
        _: u64,
        _: Span<u64>,
        _: Span<Service>,
        _: *const Answer,
        message: *mut Message,
    ) -> Status {
        guarded(message, || Ok(()))
    }
    let told = fault(Table { call: Some(call), ..sound() }, "", 3);
    assert!(told.ends_with("it gave no answer"), "{told}");
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
