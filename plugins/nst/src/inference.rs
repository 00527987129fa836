//! From a cloud to canonical coordinates: coarse network, fit, refiner.

use crate::alignment::{folded, robust};
use crate::augment::take_shuffled;
use crate::batch::{Batch, View};
use crate::dataset::FEWEST_POINTS;
use crate::network::{FEATURES, Network, Sizes};
use crate::readout::{Readout, read};
use crate::stance::Lens;
use crate::units::unfold;
use nalgebra::{Point3, Translation3, Vector3};
use rayon::prelude::*;
use seeone_core::random::generator;
use seeone_core::{Diagnostic, Similarity};
use seeone_nn::sampling::Point;
use seeone_nn::{Card, weights};
use std::path::Path;

/// Refiner passes, each from the pose that the one before gave.
const PASSES: usize = 3;
/// Draws of points that the last pass is averaged over, each with its mirror image:
/// measured, four instead of two are worth one point of Acc_nocs at 0.04 d.
const LAST_DRAWS: usize = 4;
/// Most points that are answered for.
pub const MOST_POINTS: usize = 2048;
/// What is this far above the mat does not lie on it, metres.
const ABOVE_MAT_M: f64 = 0.05;
/// Share of a cloud's points that may lie below all of the object.
const WRONG_POINTS: f64 = 0.01;
/// File names of the two networks' weights.
pub const COARSE_FILE: &str = "coarse.safetensors";
/// See [`COARSE_FILE`].
pub const REFINER_FILE: &str = "refiner.safetensors";

/// What was perceived about some of the points given.
#[derive(Clone, Debug)]
pub struct Perceived {
    /// Which points, by their place in what was given, each once and in rising order: all
    /// of them, or [`MOST_POINTS`] drawn at random.
    pub rows: Vec<usize>,
    /// Their canonical coordinates in the unit cube.
    pub nocs: Vec<Point3<f64>>,
    /// Confidence of each coordinate in `[0, 1]`.
    pub confidence: Vec<[f64; 3]>,
    /// [`FEATURES`] numbers a point.
    pub features: Vec<f32>,
    /// `world` -> centred canonical coordinates (`nocs - 0.5`), by robust fit.
    pub alignment: Similarity,
}

impl Perceived {
    /// Mean of all confidences.
    fn certainty(&self) -> f64 {
        let all = self.confidence.iter().flatten();
        all.sum::<f64>() / (3 * self.confidence.len()).max(1) as f64
    }
}

/// Why nothing was perceived.
#[derive(Debug, thiserror::Error)]
pub enum NstError {
    /// Too few points to say anything.
    #[error("{0} points are too few to perceive anything; {FEWEST_POINTS} are needed")]
    TooFewPoints(usize),
    /// A point, or the camera's position, is NaN or infinite.
    #[error("the observation is not finite")]
    NotFinite,
    /// All points coincide, or the network's answers determine no pose.
    #[error("the points determine no pose")]
    NoPose,
    /// A tensor operation failed.
    #[error("network: {0}")]
    Network(#[from] candle_core::Error),
}

/// How often the refiner is asked about one cloud.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Effort {
    /// Three passes, each from the pose that the one before gave; the last one averaged over
    /// draws of points and their mirror images.
    #[default]
    Full,
    /// Once, from the coarse fit: one forward pass, as the paper reads its network.
    OnePass,
}

/// The two trained networks.
pub struct Nst {
    effort: Effort,
    coarse: Network,
    refiner: Network,
    card: Card,
}

impl Nst {
    /// Loads the weights of `folder`, checked against its card.
    ///
    /// # Errors
    /// A located diagnostic when a file is missing, damaged or another network's.
    pub fn load(folder: &Path) -> Result<Self, Diagnostic> {
        let card = Card::read(folder)?;
        let network = |sizes, file| -> Result<Network, Diagnostic> {
            let (entry, path) = card.entry(folder, file)?;
            let network = Network::new(sizes, 0)
                .map_err(|e| Diagnostic::new("N002", e.to_string()).in_file(&path))?;
            weights::load(&path, network.parameters(), entry)?;
            Ok(network)
        };
        let coarse = network(Sizes::COARSE, COARSE_FILE)?;
        let refiner = network(Sizes::REFINER, REFINER_FILE)?;
        Ok(Self { effort: Effort::Full, coarse, refiner, card })
    }

    /// The same networks, asked as often as `effort` says.
    pub fn with_effort(self, effort: Effort) -> Self {
        Self { effort, ..self }
    }

    /// What the weights are.
    pub fn card(&self) -> &Card {
        &self.card
    }

    /// Perceives a cloud in `world` (gravity along -z, metres) seen from `camera`.
    ///
    /// What is well above the mat either hangs, as the training's lifted objects do, or stands on
    /// something else, such as a head, as the training's others do on the mat. Which of both
    /// is not told: it is perceived as it is and let down to the mat, and the more confident
    /// answer counts.
    ///
    /// # Errors
    /// [`NstError`].
    pub fn perceive(
        &self,
        points: &[Point3<f64>],
        camera: &Point3<f64>,
    ) -> Result<Perceived, NstError> {
        let as_it_is = self.perceive_there(points, camera);
        let lowest = lowest(points);
        if !lowest.is_finite() || lowest < ABOVE_MAT_M {
            return as_it_is;
        }
        let down = Translation3::new(0.0, 0.0, -lowest);
        let lowered: Vec<Point3<f64>> = points.iter().map(|p| down * p).collect();
        match (as_it_is, self.perceive_there(&lowered, &(down * camera))) {
            (Ok(as_it_is), Ok(lowered)) if as_it_is.certainty() < lowered.certainty() => {
                Ok(Perceived { alignment: lowered.alignment * down, ..lowered })
            }
            (Err(_), Ok(lowered)) => {
                Ok(Perceived { alignment: lowered.alignment * down, ..lowered })
            }
            (as_it_is, _) => as_it_is,
        }
    }

    fn perceive_there(
        &self,
        points: &[Point3<f64>],
        camera: &Point3<f64>,
    ) -> Result<Perceived, NstError> {
        let points = checked(points, camera)?;
        let start = coarse_pose(&self.coarse, &points, camera, 0)?.ok_or(NstError::NoPose)?;
        self.refine(&points, camera, &start)
    }

    /// Perceives a cloud whose pose is nearly known, such as that of an object held in the
    /// gripper; `start` is `world` -> centred canonical coordinates, right within about 40
    /// degrees.
    ///
    /// # Errors
    /// [`NstError`].
    pub fn perceive_from(
        &self,
        points: &[Point3<f64>],
        camera: &Point3<f64>,
        start: &Similarity,
    ) -> Result<Perceived, NstError> {
        self.refine(&checked(points, camera)?, camera, start)
    }

    fn refine(
        &self,
        points: &[Vector3<f64>],
        camera: &Point3<f64>,
        start: &Similarity,
    ) -> Result<Perceived, NstError> {
        let mut rng = generator(0, "nst refiner points");
        let mut all: Vec<usize> = (0..points.len()).collect();
        let mut rows = take_shuffled(&mut all, points.len().min(MOST_POINTS), &mut rng);
        let seen = take_shuffled(&mut rows, Sizes::REFINER.points, &mut rng);
        let seen: Vec<Vector3<f64>> = seen.iter().map(|row| points[*row]).collect();
        rows.sort_unstable();
        let asked: Vec<Vector3<f64>> = rows.iter().map(|row| points[*row]).collect();
        let mut pose = *start;
        let full = self.effort == Effort::Full;
        for _ in 1..if full { PASSES } else { 1 } {
            let (readout, _) = self.ask(&Lens::refiner(&pose), camera, &seen, &seen)?;
            pose = fit(&seen, &readout).ok_or(NstError::NoPose)?;
        }
        let lens = Lens::refiner(&pose);
        let mut draws = vec![seen];
        for _ in 1..if full { LAST_DRAWS } else { 1 } {
            let other = take_shuffled(&mut rows.clone(), Sizes::REFINER.points, &mut rng);
            draws.push(other.iter().map(|row| points[*row]).collect());
        }
        let sides: &[bool] = if full { &[false, true] } else { &[false] };
        let views: Vec<_> = draws.iter().flat_map(|d| sides.iter().map(move |s| (d, *s))).collect();
        let ask = |(seen, side): &(&Vec<Vector3<f64>>, bool)| {
            self.ask(&lens.mirrored(*side), camera, seen, &asked)
        };
        let answers = views.par_iter().map(ask).collect::<candle_core::Result<Vec<_>>>()?;
        let (readouts, mut features): (Vec<_>, Vec<_>) = answers.into_iter().unzip();
        let readout = Readout::mean(&readouts);
        let alignment = fit(&asked, &readout).ok_or(NstError::NoPose)?;
        let nocs = readout.values.into_iter().map(Point3::from).collect();
        let features = features.swap_remove(0); // those of the first draw as it is
        Ok(Perceived { rows, nocs, confidence: readout.confidence, features, alignment })
    }

    /// One refiner pass: coordinates and features of `asked`, seen through `lens`.
    fn ask(
        &self,
        lens: &Lens,
        camera: &Point3<f64>,
        seen: &[Vector3<f64>],
        asked: &[Vector3<f64>],
    ) -> candle_core::Result<(Readout, Vec<f32>)> {
        let see = |points: &[Vector3<f64>]| -> Vec<Point> {
            points.iter().map(|p| lens.see(p)).collect()
        };
        let (points, queries) = (see(seen), see(asked));
        let view = View { points: &points, queries: &queries, stance: lens.stance(camera) };
        let output = self.refiner.forward(&Batch::new(self.refiner.sizes(), &[view])?)?;
        let mut readout = read(&output.logits)?;
        if lens.is_mirror() {
            readout.values.iter_mut().for_each(|v| v[0] = 1.0 - v[0]);
        }
        let features = output.features.flatten_all()?.to_vec1()?;
        debug_assert_eq!(features.len(), asked.len() * FEATURES);
        Ok((readout, features))
    }
}

/// How high the lowest points are, but for a few that a camera got wrong, metres.
fn lowest(points: &[Point3<f64>]) -> f64 {
    let mut heights: Vec<f64> = points.iter().map(|p| p.z).collect();
    heights.sort_by(f64::total_cmp);
    heights.get((WRONG_POINTS * heights.len() as f64) as usize).copied().unwrap_or(f64::NAN)
}

fn checked(points: &[Point3<f64>], camera: &Point3<f64>) -> Result<Vec<Vector3<f64>>, NstError> {
    if !camera.coords.iter().all(|v| v.is_finite()) {
        return Err(NstError::NotFinite);
    }
    if points.len() < FEWEST_POINTS {
        return Err(NstError::TooFewPoints(points.len()));
    }
    if !points.iter().all(|p| p.coords.iter().all(|v| v.is_finite())) {
        return Err(NstError::NotFinite);
    }
    Ok(points.iter().map(|p| p.coords).collect())
}

/// The pose that the coarse network's answers make (`world` -> centred canonical
/// coordinates), on points drawn with `seed`; nothing when they determine none.
///
/// # Errors
/// What candle reports.
pub fn coarse_pose(
    network: &Network,
    points: &[Vector3<f64>],
    camera: &Point3<f64>,
    seed: u64,
) -> candle_core::Result<Option<Similarity>> {
    let mut rng = generator(seed, "nst coarse points");
    let mut all: Vec<usize> = (0..points.len()).collect();
    let rows = take_shuffled(&mut all, Sizes::COARSE.points, &mut rng);
    let seen: Vec<Vector3<f64>> = rows.iter().map(|row| points[*row]).collect();
    let lens = Lens::coarse(&seen, camera);
    let cloud: Vec<Point> = seen.iter().map(|p| lens.see(p)).collect();
    let view = View { points: &cloud, queries: &cloud, stance: lens.stance(camera) };
    let batch = Batch::new(network.sizes(), &[view])?;
    let readout = read(&network.forward(&batch)?.logits)?;
    let to: Vec<Vector3<f64>> = readout.values.iter().map(unfold).collect();
    Ok(folded(&seen, &to, &weights_of(&readout)))
}

fn weights_of(readout: &Readout) -> Vec<f64> {
    readout.confidence.iter().map(|c| c[0] * c[1] * c[2]).collect()
}

fn fit(points: &[Vector3<f64>], readout: &Readout) -> Option<Similarity> {
    let to: Vec<Vector3<f64>> =
        readout.values.iter().map(|v| Vector3::from(*v) - Vector3::repeat(0.5)).collect();
    robust(points, &to, &weights_of(readout))
}
