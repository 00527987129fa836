//! Training of both networks, from a set of frames to weights with a card.

use crate::dataset::{AlignedFrame, Dataset};
use crate::evaluate::{Figures, Group, evaluate};
use crate::examples::{self, Example, Start, stack};
use crate::inference::{COARSE_FILE, Nst, REFINER_FILE, coarse_pose};
use crate::network::{Network, Sizes};
use nalgebra::{Point3, Vector3};
use rand::RngExt;
use rayon::prelude::*;
use seeone_core::frames::{Index, Moment, read_all};
use seeone_core::random::{Generator, generator, uniform};
use seeone_core::{Diagnostic, Similarity};
use seeone_nn::ops::cross_entropy;
use seeone_nn::train::Ending;
use seeone_nn::weights::{self, Precision};
use seeone_nn::{Card, Plan, Progress, TrainError, WeightsEntry, train as optimise};
use std::collections::BTreeMap;
use std::ops::{ControlFlow, Range};
use std::path::{Path, PathBuf};

/// Samples a step.
const BATCH: u64 = 8;
/// Learning rate of the schedule's flat part.
const PEAK_RATE: f64 = 1.5e-3;
/// Samples between two checkpoints: about a minute's work.
const CHECKPOINT_EVERY: u64 = 4096;
/// Poses that the coarse network is asked for on each training frame.
const FITS: usize = 2;

/// What to train on, for how long, and where to.
#[derive(Clone, Debug)]
pub struct TrainPlan {
    /// The set of frames.
    pub data: PathBuf,
    /// Sets of other objects by name (`validation`, `unseen`), for the card's figures.
    pub measure_on: BTreeMap<String, PathBuf>,
    /// Folder for checkpoints, weights and card.
    pub out: PathBuf,
    /// Seed of initial weights and of every draw.
    pub seed: u64,
    /// Samples of the coarse network.
    pub coarse_samples: u64,
    /// Samples of the refiner.
    pub refiner_samples: u64,
    /// Category of the objects, for the card.
    pub category: String,
    /// The command that trains, for the card.
    pub command: String,
}

/// Which part of the training is under way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// The coarse network.
    Coarse,
    /// Asking the coarse network for starts.
    Starts,
    /// The refiner.
    Refiner,
    /// Measuring on objects that were not trained on.
    Evaluation,
}

/// How far the training is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageProgress {
    /// Which part.
    pub stage: Stage,
    /// Samples (frames, sets) done and in all; the loss where there is one.
    pub progress: Progress,
}

/// What came of it.
#[derive(Clone, Debug, PartialEq)]
pub enum Report {
    /// Weights and card are written; figures by the name of the set.
    Finished(BTreeMap<String, Figures>),
    /// The caller broke off; the same plan continues from the checkpoint.
    Interrupted,
}

/// Why there are no weights.
#[derive(Debug, thiserror::Error)]
pub enum NstTrainError {
    /// A file is missing, damaged or cannot be written.
    #[error(transparent)]
    File(#[from] Diagnostic),
    /// The training failed.
    #[error(transparent)]
    Train(#[from] TrainError),
}

impl From<candle_core::Error> for NstTrainError {
    fn from(error: candle_core::Error) -> Self {
        Self::Train(error.into())
    }
}

type Told<'a> = &'a mut dyn FnMut(StageProgress) -> ControlFlow<()>;

/// Trains the coarse network, asks it for starts on the training frames, trains the
/// refiner from random starts and from those, and measures. Deterministic in the plan;
/// interrupted (by `progress` or by a power cut), the same call continues.
///
/// # Errors
/// [`NstTrainError`].
pub fn train(plan: &TrainPlan, progress: Told<'_>) -> Result<Report, NstTrainError> {
    std::fs::create_dir_all(&plan.out)
        .map_err(|e| Diagnostic::new("N003", e.to_string()).in_file(&plan.out))?;
    let (set, index) = Dataset::read(&plan.data)?;

    let coarse = Network::new(Sizes::COARSE, plan.seed)?;
    let draw = |rng: &mut Generator| examples::coarse(&set.frames()[set.draw_on_mat(rng)], rng);
    let data = format!("data seed {}", index.seed);
    if run(&coarse, plan, Which::Coarse, &data, &draw, progress)? == Ending::Interrupted {
        return Ok(Report::Interrupted);
    }
    let coarse_entry = store(&coarse, &plan.out.join(COARSE_FILE))?;

    let starts = starts(&coarse, &set, progress)?;
    let refiner = Network::new(Sizes::REFINER, plan.seed)?;
    let draw = |rng: &mut Generator| {
        let number = set.draw(rng);
        let fit = starts[number][rng.random_range(0..FITS)].as_ref();
        let start = match fit {
            Some(fit) if uniform(rng, 0.0, 1.0) < 0.5 => Start::Fit(fit),
            _ => Start::Random,
        };
        examples::refiner(&set.frames()[number], start, rng)
    };
    let data = format!("{data}, starts from {}", coarse_entry.blake3);
    if run(&refiner, plan, Which::Refiner, &data, &draw, progress)? == Ending::Interrupted {
        return Ok(Report::Interrupted);
    }
    let refiner_entry = store(&refiner, &plan.out.join(REFINER_FILE))?;

    let mut card = card(plan, &index, vec![coarse_entry, refiner_entry]);
    card.write(&plan.out)?;
    let report = measure(plan, &mut card, progress)?;
    for which in [Which::Coarse, Which::Refiner] {
        let path = which.checkpoint(plan);
        std::fs::remove_file(&path)
            .map_err(|e| Diagnostic::new("N003", e.to_string()).in_file(&path))?;
    }
    Ok(report)
}

/// One of the two networks.
#[derive(Clone, Copy)]
enum Which {
    Coarse,
    Refiner,
}

impl Which {
    fn name(self) -> &'static str {
        match self {
            Self::Coarse => "coarse",
            Self::Refiner => "refiner",
        }
    }

    fn checkpoint(self, plan: &TrainPlan) -> PathBuf {
        plan.out.join(self.name()).with_extension("checkpoint")
    }
}

/// Trains one network on what `draw` makes of `data`.
fn run(
    network: &Network,
    plan: &TrainPlan,
    which: Which,
    data: &str,
    draw: &(dyn Fn(&mut Generator) -> Example + Sync),
    progress: Told<'_>,
) -> Result<Ending, NstTrainError> {
    let name = which.name();
    let (samples, stage) = match which {
        Which::Coarse => (plan.coarse_samples, Stage::Coarse),
        Which::Refiner => (plan.refiner_samples, Stage::Refiner),
    };
    let inner = Plan {
        label: format!("nst {name}, seed {}, {data}", plan.seed),
        samples,
        batch: BATCH,
        peak_rate: PEAK_RATE,
        checkpoint_every: CHECKPOINT_EVERY,
    };
    let loss = |samples: Range<u64>| {
        let examples: Vec<Example> =
            samples.map(|n| draw(&mut generator(plan.seed, &format!("{name} {n}")))).collect();
        let (batch, targets) = stack(network.sizes(), &examples)?;
        cross_entropy(&network.forward(&batch)?.logits, targets)
    };
    let mut told = |p| progress(StageProgress { stage, progress: p });
    let checkpoint = which.checkpoint(plan);
    Ok(optimise::train(network.parameters(), &inner, Some(&checkpoint), &loss, &mut told)?)
}

/// Stores weights in half precision and goes on with what was stored, so that everything
/// later is made with the weights that a user has.
fn store(network: &Network, path: &Path) -> Result<WeightsEntry, NstTrainError> {
    let entry = weights::save(path, network.parameters(), Precision::Half)?;
    weights::load(path, network.parameters(), &entry)?;
    Ok(entry)
}

/// Poses that the coarse network gives for each training frame.
fn starts(
    network: &Network,
    set: &Dataset,
    progress: Told<'_>,
) -> Result<Vec<[Option<Similarity>; FITS]>, NstTrainError> {
    let total = set.frames().len() as u64;
    let mut tell = |done| {
        let told = Progress { done, total, loss: 0.0 };
        let _ = progress(StageProgress { stage: Stage::Starts, progress: told });
    };
    tell(0);
    let fits = |frame: &AlignedFrame| -> candle_core::Result<[Option<Similarity>; FITS]> {
        if frame.frame.info.moment == Moment::Held {
            return Ok([None; FITS]); // its pose comes from the hand, not from the coarse network
        }
        let points: Vec<Vector3<f64>> =
            frame.frame.points.iter().map(|p| Vector3::from(p.map(f64::from))).collect();
        let camera = Point3::from(frame.frame.info.camera.xyz_m);
        let mut fits = [None; FITS];
        for (seed, fit) in fits.iter_mut().enumerate() {
            *fit = coarse_pose(network, &points, &camera, seed as u64)?;
        }
        Ok(fits)
    };
    let fits = set.frames().par_iter().map(fits).collect::<candle_core::Result<_>>()?;
    tell(total);
    Ok(fits)
}

fn card(plan: &TrainPlan, index: &Index, weights: Vec<WeightsEntry>) -> Card {
    Card {
        schema: 1,
        network: "nst".into(),
        category: plan.category.clone(),
        data_seed: index.seed,
        seed: plan.seed,
        command: plan.command.clone(),
        samples: BTreeMap::from([
            ("coarse".into(), plan.coarse_samples),
            ("refiner".into(), plan.refiner_samples),
        ]),
        requires: BTreeMap::new(),
        figures: BTreeMap::new(),
        weights,
    }
}

/// Measures the stored weights and writes the figures into the card.
fn measure(plan: &TrainPlan, card: &mut Card, progress: Told<'_>) -> Result<Report, NstTrainError> {
    let nst = Nst::load(&plan.out)?;
    let mut all = BTreeMap::new();
    for (done, (name, folder)) in plan.measure_on.iter().enumerate() {
        let total = plan.measure_on.len() as u64;
        let told = Progress { done: done as u64, total, loss: 0.0 };
        let _ = progress(StageProgress { stage: Stage::Evaluation, progress: told });
        let (index, frames) = read_all(folder)?;
        let figures = Figures::of(&evaluate(&nst, &index.objects, &frames));
        note(card, name, &figures);
        all.insert(name.clone(), figures);
    }
    card.write(&plan.out)?;
    Ok(Report::Finished(all))
}

/// Writes `figures` on the frames of `set` into the card of the weights in `folder`.
///
/// # Errors
/// When the card cannot be read or written.
pub fn record(folder: &Path, set: &str, figures: &Figures) -> Result<(), Diagnostic> {
    let mut card = Card::read(folder)?;
    note(&mut card, set, figures);
    card.write(folder)
}

fn note(card: &mut Card, set: &str, figures: &Figures) {
    let groups =
        [("settled", &figures.settled), ("falling", &figures.falling), ("held", &figures.held)];
    for (state, group) in groups {
        let Group { frames, refused, within_004_d, within_01_d, mirrored, over_30_degrees } =
            *group;
        let named = [
            ("frames", frames as f64),
            ("refused_frames", refused as f64),
            ("points_within_0.04_d", within_004_d),
            ("points_within_0.1_d", within_01_d),
            ("points_mirrored", mirrored),
            ("frames_over_30_deg", over_30_degrees),
        ];
        for (name, value) in named {
            card.figures.insert(format!("{set}_{state}_{name}"), value);
        }
    }
}
