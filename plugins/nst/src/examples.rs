//! What the networks are trained on: one example from one frame and one stream of chance.

use crate::augment::{Sample, draw};
use crate::batch::{Batch, View};
use crate::dataset::AlignedFrame;
use crate::network::Sizes;
use crate::stance::{Lens, Stance};
use crate::units::fold;
use candle_core::Result;
use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use seeone_core::Similarity;
use seeone_core::random::{Generator, direction, normal, uniform};
use seeone_nn::ops::BinTargets;
use seeone_nn::sampling::Point;

/// Noise added to every coordinate (m).
const JITTER_M: f64 = 0.001;
/// Largest change of size.
const SIZES: f64 = 0.08;
/// Largest turn away from the camera's azimuth (rad).
const YAW: f64 = 25.0 * DEGREE;
/// Deviation of a refiner start's size and place (canonical units).
const START_SCALE: f64 = 0.06;
const START_SHIFT: f64 = 0.04;
/// Deviations of what is added to a start that the coarse network gave.
const FIT_TURN: f64 = 6.0 * DEGREE;
const FIT_SHIFT: f64 = 0.012;
/// Deviation of target distributions in bins.
const SOFTNESS: f32 = 1.5;
const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// One cloud in network units; the first half of the points are the queries, so that the
/// wide layers run on half of them.
#[derive(Clone, Debug)]
pub struct Example {
    points: Vec<Point>,
    /// How they were seen.
    stance: Stance,
    /// Coordinates of each query in `[0, 1]`.
    targets: Vec<[f32; 3]>,
}

impl Example {
    fn view(&self) -> View<'_> {
        let queries = &self.points[..self.targets.len()];
        View { points: &self.points, queries, stance: self.stance }
    }
}

/// Where the refiner starts from.
#[derive(Clone, Copy, Debug)]
pub enum Start<'a> {
    /// From the true pose, disturbed at random.
    Random,
    /// From a pose that the coarse network gave for this frame.
    Fit(&'a Similarity),
}

/// A cloud as it lies, for the coarse network.
pub fn coarse(frame: &AlignedFrame, rng: &mut Generator) -> Example {
    let sample = draw(frame, Sizes::COARSE.points, rng);
    let camera = Point3::from(frame.frame.info.camera.xyz_m);
    let yaw = uniform(rng, -YAW, YAW);
    let scale = uniform(rng, 1.0 - SIZES, 1.0 + SIZES);
    // The folded targets of the mirror image are the same.
    let lens = Lens::coarse(&sample.points, &camera).turned(yaw, scale).mirrored(mirror(rng));
    let points = seen(&lens, &sample, rng);
    let stance = lens.stance(&camera).resized(scale);
    let queries = sample.targets.len() / 2;
    Example { points, stance, targets: sample.targets[..queries].iter().map(fold).collect() }
}

/// A cloud in a nearly right pose, for the refiner.
pub fn refiner(frame: &AlignedFrame, start: Start<'_>, rng: &mut Generator) -> Example {
    let sample = draw(frame, Sizes::REFINER.points, rng);
    let pose = match start {
        Start::Random => disturbed(&frame.alignment, &sample, random_turn(rng), START_SHIFT, rng),
        Start::Fit(fit) => disturbed(fit, &sample, FIT_TURN * normal(rng).abs(), FIT_SHIFT, rng),
    };
    let mirrored = mirror(rng);
    let side = if mirrored { -1.0 } else { 1.0 };
    let lens = Lens::refiner(&pose).mirrored(mirrored);
    let points = seen(&lens, &sample, rng);
    let camera = Point3::from(frame.frame.info.camera.xyz_m);
    let stance = lens.stance(&camera).resized(uniform(rng, 1.0 - SIZES, 1.0 + SIZES));
    let queries = sample.targets.len() / 2;
    let targets = sample.targets[..queries]
        .iter()
        .map(|t| [(side * t.x + 0.5) as f32, (t.y + 0.5) as f32, (t.z + 0.5) as f32]);
    Example { points, stance, targets: targets.collect() }
}

/// Half of the random starts are near, half anywhere within 60 degrees.
fn random_turn(rng: &mut Generator) -> f64 {
    if uniform(rng, 0.0, 1.0) < 0.5 {
        (20.0 * DEGREE * normal(rng)).abs()
    } else {
        uniform(rng, 0.0, 60.0 * DEGREE)
    }
}

/// `pose` turned by `angle` about a random axis through the cloud, moved and, where it was
/// moved far, rescaled.
fn disturbed(
    pose: &Similarity,
    sample: &Sample,
    angle: f64,
    shift: f64,
    rng: &mut Generator,
) -> Similarity {
    let mean = sample.points.iter().sum::<Vector3<f64>>() / sample.points.len() as f64;
    let centre = pose.transform_point(&Point3::from(mean)).coords;
    let turn = UnitQuaternion::from_scaled_axis(direction(rng) * angle);
    let scale = 1.0 + START_SCALE * (shift / START_SHIFT) * normal(rng).clamp(-3.0, 3.0);
    let about =
        Similarity::from_parts(Translation3::from(centre + noise(rng) * shift), turn, scale);
    about * Translation3::from(-centre) * pose
}

/// The sample's points with the camera's noise.
fn seen(lens: &Lens, sample: &Sample, rng: &mut Generator) -> Vec<Point> {
    sample.points.iter().map(|p| lens.see(&(p + noise(rng) * JITTER_M))).collect()
}

fn mirror(rng: &mut Generator) -> bool {
    uniform(rng, 0.0, 1.0) < 0.5
}

fn noise(rng: &mut Generator) -> Vector3<f64> {
    Vector3::from_fn(|_, _| normal(rng))
}

/// Stacks examples for a network.
///
/// # Errors
/// When an example is of another size.
pub fn stack(sizes: Sizes, examples: &[Example]) -> Result<(Batch, BinTargets)> {
    let views: Vec<View<'_>> = examples.iter().map(Example::view).collect();
    let values: Vec<f32> =
        examples.iter().flat_map(|e| e.targets.iter().flatten().copied()).collect();
    let weights = vec![1.0; values.len() / 3];
    Ok((Batch::new(sizes, &views)?, BinTargets { values, weights, softness: SOFTNESS }))
}
