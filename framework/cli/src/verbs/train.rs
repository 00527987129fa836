//! `train`: the networks, from a set of frames to weights with their cards.

use crate::args::{Network, TrainArgs};
use crate::shown::observation;
use crate::{Ending, console};
use anyhow::{Error, Result};
use indicatif::{ProgressBar, ProgressStyle};
use seeone_core::frames::Frame;
use seeone_nn::train::Ending as Trained;
use seeone_nse::{Nse, Progress as NseProgress};
use seeone_nst::{NstPerception, NstTrainError, Report, Stage};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Samples of a full training; `--share` takes a part of them.
const COARSE_SAMPLES: f64 = 64_000.0;
const REFINER_SAMPLES: f64 = 320_000.0;
const NSE_SAMPLES: f64 = 4_000.0;
/// Frames at rest that the encoding learns from.
const NSE_FRAMES: usize = 1_600;

/// Trains what was asked for; continues what was interrupted.
///
/// # Errors
/// When the set cannot be read, or weights cannot be written.
pub fn run(args: &TrainArgs) -> Result<Ending> {
    let stop = Arc::new(AtomicBool::new(false));
    let ordered = Arc::clone(&stop);
    ctrlc::set_handler(move || ordered.store(true, Ordering::Relaxed))?;
    let go_on = || {
        if stop.load(Ordering::Relaxed) {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    };
    let (nst, nse) = (args.out.join("nst/weights"), args.out.join("nse/weights"));
    let mut whole = true;
    if args.network != Network::Nse {
        whole = train_nst(args, &nst, &go_on)?;
    }
    if whole && args.network != Network::Nst {
        whole = train_nse(args, &nst, &nse, &go_on)?;
    }
    if !whole {
        console::tell("interrupted; the same command goes on from the checkpoint");
    }
    Ok(if whole { Ending::Success } else { Ending::Failure })
}

fn command(args: &TrainArgs, network: &str) -> String {
    format!(
        "seeone train {network} --data {} --seed {} --share {}",
        args.data.display(),
        args.seed,
        args.share
    )
}

fn samples(full: f64, args: &TrainArgs) -> u64 {
    (full * args.share).round().max(1.0) as u64
}

/// The sets of other objects that lie beside the training set, for the cards' figures.
fn measure_on(args: &TrainArgs) -> BTreeMap<String, PathBuf> {
    let sets = ["validation", "unseen"].map(|name| (name, args.data.with_file_name(name)));
    let there = sets.into_iter().filter(|(_, folder)| folder.join("index.json").exists());
    there.map(|(name, folder)| (name.to_owned(), folder)).collect()
}

fn bar() -> Result<ProgressBar> {
    let style = "{msg} {wide_bar} {pos}/{len}, {per_sec}, {eta} left";
    Ok(ProgressBar::new(0).with_style(ProgressStyle::with_template(style)?))
}

fn train_nst(args: &TrainArgs, out: &Path, go_on: &dyn Fn() -> ControlFlow<()>) -> Result<bool> {
    let plan = seeone_nst::TrainPlan {
        data: args.data.clone(),
        measure_on: measure_on(args),
        out: out.to_owned(),
        seed: args.seed,
        coarse_samples: samples(COARSE_SAMPLES, args),
        refiner_samples: samples(REFINER_SAMPLES, args),
        category: "cap".into(),
        command: command(args, "nst"),
    };
    let bar = bar()?;
    let mut stage: Option<Stage> = None;
    let report = seeone_nst::train(&plan, &mut |told| {
        if stage != Some(told.stage) {
            stage = Some(told.stage);
            bar.reset();
        }
        bar.set_length(told.progress.total);
        bar.set_position(told.progress.done);
        bar.set_message(format!("nst {:?} {}", told.stage, loss(told.progress.loss)));
        go_on()
    })
    .map_err(told)?;
    bar.finish_and_clear();
    let Report::Finished(figures) = report else { return Ok(false) };
    for (set, figures) in &figures {
        console::tell(&format!("nst on {set}: {}", serde_json::to_string(figures)?));
    }
    Ok(true)
}

/// A wrong file is the fault of what was given, not of the training.
fn told(error: NstTrainError) -> Error {
    match error {
        NstTrainError::File(fault) => fault.into(),
        other => other.into(),
    }
}

fn train_nse(
    args: &TrainArgs,
    perception: &Path,
    out: &Path,
    go_on: &dyn Fn() -> ControlFlow<()>,
) -> Result<bool> {
    let nst = NstPerception::load(perception)?;
    let plan = seeone_nse::TrainPlan {
        data: args.data.clone(),
        perception: perception.to_owned(),
        out: out.to_owned(),
        seed: args.seed,
        samples: samples(NSE_SAMPLES, args),
        frames: NSE_FRAMES,
        command: command(args, "nse"),
    };
    let bar = bar()?;
    let perceive = |frame: &Frame| nst.canonical(&observation(frame));
    let mut tell = |told| {
        match told {
            NseProgress::Perceiving { done, total } => {
                bar.set_length(total as u64);
                bar.set_position(done as u64);
                bar.set_message("nse: perceiving the frames");
            }
            NseProgress::Training(progress) => {
                bar.set_length(progress.total);
                bar.set_position(progress.done);
                bar.set_message(format!("nse {}", loss(progress.loss)));
            }
        }
        go_on()
    };
    if seeone_nse::train(&plan, &perceive, &mut tell)? == Trained::Interrupted {
        return Ok(false);
    }
    bar.finish_and_clear();
    let nse = Nse::load(out, perception)?;
    for (set, folder) in measure_on(args) {
        // Not to be interrupted: the weights are whole, and their checkpoint is gone.
        let mut go_on = |_| ControlFlow::Continue(());
        if let Some(figures) = seeone_nse::evaluate(&nse, &folder, &perceive, &mut go_on)? {
            seeone_nse::record(out, &set, &figures)?;
            console::tell(&format!("nse on {set}: {figures:?}"));
        }
    }
    Ok(true)
}

fn loss(value: f64) -> String {
    if value.is_finite() { format!("loss {value:.4}") } else { String::new() }
}
