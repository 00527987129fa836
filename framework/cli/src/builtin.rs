//! The plugins that the binary is linked with, by kind and name; the first of a kind is
//! what is meant when nobody names one.

use crate::args::LibraryArgs;
use anyhow::Result;
use seeone_camera_sim::{RecordedCamera, SimulatedCamera};
use seeone_core::Diagnostic;
use seeone_feature_match::FeatureMatch;
use seeone_motion::{JointLine, Planner};
use seeone_plugin::abi::{Library, Offer};
use seeone_plugin::{Kind, Setup};
use seeone_procrustes::{Procrustes, Ransac};
use seeone_qp_ik::{DampedLeastSquares, QpIk};
use seeone_runtime::methods::Methods;
use seeone_runtime::registry::Registry;
use seeone_unchanged::{Snap, Unchanged};
use seeone_ur5_ag95_sim::SimulatedArm;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Where the networks' weights lie, from the folder in which the binary is run.
pub const WEIGHTS: [&str; 2] = ["plugins/nst/weights", "plugins/nse/weights"];

/// Every plugin that is linked in.
pub fn registry() -> Registry {
    let mut all = Registry::new();
    all.camera.add("camera-sim", |setup| Ok(Box::new(SimulatedCamera::from_setup(setup)?)));
    all.camera.add("camera-file", |setup| Ok(Box::new(RecordedCamera::from_setup(setup)?)));
    all.perception.add("nst", |setup| Ok(Box::new(seeone_nst::build(setup)?)));
    all.perception.add("nst-one-pass", |setup| Ok(Box::new(seeone_nst::build_one_pass(setup)?)));
    all.encoding.add("nse", |setup| Ok(Box::new(seeone_nse::build(setup)?)));
    all.encoding
        .add("nearest-feature", |setup| Ok(Box::new(seeone_nse::build_nearest_feature(setup)?)));
    all.alignment.add("procrustes", |setup| Ok(Box::new(Procrustes::from_setup(setup)?)));
    all.alignment.add("ransac", |setup| Ok(Box::new(Ransac::from_setup(setup)?)));
    all.transfer.add("feature-match", |setup| Ok(Box::new(FeatureMatch::from_setup(setup)?)));
    all.transfer.add("snap", |setup| Ok(Box::new(Snap::from_setup(setup)?)));
    all.transfer.add("unchanged", |setup| Ok(Box::new(Unchanged::from_setup(setup)?)));
    all.kinematics.add("qp-ik", |setup| Ok(Box::new(QpIk::from_setup(setup)?)));
    all.kinematics
        .add("damped-least-squares", |setup| Ok(Box::new(DampedLeastSquares::from_setup(setup)?)));
    all.motion.add("motion", |setup| Ok(Box::new(Planner::from_setup(setup)?)));
    all.motion.add("joint-line", |setup| Ok(Box::new(JointLine::from_setup(setup)?)));
    all.robot.add("ur5-ag95-sim", |setup| Ok(Box::new(SimulatedArm::lagging(setup)?)));
    all.robot.add("ideal-sim", |setup| Ok(Box::new(SimulatedArm::ideal(setup)?)));
    all
}

/// Loads trusted dynamic libraries; each of their plugins serves its kind under its own name,
/// in place of a linked plugin of that name.
///
/// # Errors
/// When a library has no manifest, is not the file that was trusted, is no plugin, or has a
/// plugin of the kind and the name of another library's.
pub fn load(registry: &mut Registry, libraries: &LibraryArgs) -> Result<()> {
    let LibraryArgs { plugins, patience } = libraries;
    // Zero is for ever.
    let patience = (!patience.is_zero()).then_some(*patience);
    let mut loaded: BTreeMap<(Kind, String), &PathBuf> = BTreeMap::new();
    for path in plugins {
        for offer in Library::open(path)?.offers() {
            let (kind, name) = (offer.id.kind, offer.id.name.clone());
            if let Some(other) = loaded.insert((kind, name.clone()), path) {
                let cause = format!("{} has a {kind} plugin \"{name}\" too", other.display());
                let hint = "load one of them";
                return Err(Diagnostic::new("L012", cause).in_file(path).hint(hint).into());
            }
            add(registry, offer.clone(), patience);
        }
    }
    Ok(())
}

/// Registers a loaded plugin.
fn add(all: &mut Registry, offer: Offer, patience: Option<Duration>) {
    let name = offer.id.name.clone();
    let kind = offer.id.kind;
    let build = move |setup: &Setup| offer.build(setup, patience);
    match kind {
        Kind::Camera => all.camera.add(&name, move |setup| Ok(Box::new(build(setup)?))),
        Kind::Perception => all.perception.add(&name, move |setup| Ok(Box::new(build(setup)?))),
        Kind::Encoding => all.encoding.add(&name, move |setup| Ok(Box::new(build(setup)?))),
        Kind::Alignment => all.alignment.add(&name, move |setup| Ok(Box::new(build(setup)?))),
        Kind::Transfer => all.transfer.add(&name, move |setup| Ok(Box::new(build(setup)?))),
        Kind::Kinematics => all.kinematics.add(&name, move |setup| Ok(Box::new(build(setup)?))),
        Kind::Motion => all.motion.add(&name, move |setup| Ok(Box::new(build(setup)?))),
        Kind::Robot => all.robot.add(&name, move |setup| Ok(Box::new(build(setup)?))),
    }
}

/// What else must be known to repeat a run: the version and the hashes of the weights.
///
/// # Errors
/// When weights cannot be read.
pub fn provenance(methods: &Methods) -> Result<BTreeMap<String, String>> {
    let mut known = BTreeMap::from([("seeone".to_owned(), env!("CARGO_PKG_VERSION").to_owned())]);
    let learned = [Kind::Perception, Kind::Encoding].map(|kind| methods.name(kind));
    for (folder, name) in WEIGHTS.iter().zip(learned) {
        if !name.starts_with("ns") {
            continue;
        }
        for file in weights_in(Path::new(folder)) {
            if let Ok(bytes) = fs::read(&file) {
                let hash = blake3::hash(&bytes).to_hex().to_string();
                known.insert(file.display().to_string(), hash);
            }
        }
    }
    Ok(known)
}

/// The weights of a folder by name; none when the folder is not there, which the plugin
/// that needs them tells better.
fn weights_in(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let mut files: Vec<PathBuf> = entries
        .filter_map(|entry| entry.ok().map(|e| e.path()))
        .filter(|path| path.extension().is_some_and(|e| e == "safetensors"))
        .collect();
    files.sort();
    files
}
