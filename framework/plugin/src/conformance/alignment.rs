//! The rules of kind `alignment`.

use super::violation::{Violation, answered, answered_or_refused, hold, refused, sound};
use crate::{Alignment, AlignmentOutcome, Correspondences};
use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use seeone_core::random::{direction, generator, normal};
use seeone_core::{Pose, Similarity};

/// How far two transforms that should be one may move a point of the set apart, in units
/// of the target (whose size is about 0.3): robust solvers stop a little short.
const SAME: f64 = 1e-6;

/// Pairs that an alignment is tried on: points on a dome of unit size, and where a known
/// similarity carries them, with noise.
struct Pairs {
    source: Vec<Point3<f64>>,
    target: Vec<Point3<f64>>,
    weights: Vec<f64>,
}

impl Pairs {
    fn new(truth: &Similarity, noise: f64) -> Self {
        let mut rng = generator(0, "conformance-alignment");
        let source: Vec<_> = (0..80)
            .map(|_| {
                let d = direction(&mut rng);
                Point3::new(0.35 * d.x, 0.45 * d.y, 0.4 * d.z.abs())
            })
            .collect();
        let mut jitter = || noise * normal(&mut rng);
        let target =
            source.iter().map(|p| truth * p + Vector3::new(jitter(), jitter(), jitter())).collect();
        Self { weights: (0..source.len()).map(|i| 0.5 + (i % 3) as f64).collect(), source, target }
    }

    fn view(&self, fixed_scale: Option<f64>) -> Correspondences<'_> {
        Correspondences {
            source: &self.source,
            target: &self.target,
            weights: &self.weights,
            fixed_scale,
        }
    }
}

/// How far two similarities move the points of `pairs` apart, at most.
fn apart(pairs: &Pairs, a: &Similarity, b: &Similarity) -> f64 {
    pairs.source.iter().map(|p| (a * p - b * p).norm()).fold(0.0, f64::max)
}

/// Holds every rule of the kind.
///
/// # Errors
/// The first rule that `plugin` breaks.
pub fn alignment(plugin: &dyn Alignment) -> Result<(), Violation> {
    let truth = Similarity::from_parts(
        Vector3::new(0.4, -0.2, 0.1).into(),
        UnitQuaternion::from_euler_angles(2.0, -0.4, 1.1),
        0.26,
    );
    finds_what_is_there(plugin, &truth)?;
    keeps_its_ranges_and_its_bytes(plugin, &truth)?;
    follows_the_target(plugin, &truth)?;
    refuses_what_is_wrong(plugin, &truth)
}

fn finds_what_is_there(plugin: &dyn Alignment, truth: &Similarity) -> Result<(), Violation> {
    let rule = "an exact similarity is found";
    let pairs = Pairs::new(truth, 0.0);
    let found = answered(rule, || plugin.align(&pairs.view(None)))?;
    let error = apart(&pairs, &found.transform, truth);
    hold(rule, error < SAME, || format!("points are {error:.2e} off"))?;

    let rule = "a fixed scale is kept to the bit";
    let found = answered(rule, || plugin.align(&pairs.view(Some(0.3))))?;
    let scale = found.transform.scaling();
    hold(rule, scale == 0.3, || format!("asked for 0.3, got {scale}"))
}

fn keeps_its_ranges_and_its_bytes(
    plugin: &dyn Alignment,
    truth: &Similarity,
) -> Result<(), Violation> {
    let rule = "finite in, finite and within its range out";
    let pairs = Pairs::new(truth, 0.004);
    let found = answered(rule, || plugin.align(&pairs.view(None)))?;
    sound(rule, found.check())?;

    let rule = "the same input gives the same bytes";
    let again = answered(rule, || plugin.align(&pairs.view(None)))?;
    hold(rule, bits(&found) == bits(&again), || format!("{found:?} and {again:?}"))
}

/// Every number of an outcome, bit by bit.
pub fn bits(outcome: &AlignmentOutcome) -> [u64; 11] {
    let rotation = outcome.transform.isometry.rotation.coords;
    let shift = outcome.transform.isometry.translation.vector;
    [
        rotation.x,
        rotation.y,
        rotation.z,
        rotation.w,
        shift.x,
        shift.y,
        shift.z,
        outcome.transform.scaling(),
        outcome.residual,
        outcome.inlier_share,
        outcome.condition,
    ]
    .map(f64::to_bits)
}

fn follows_the_target(plugin: &dyn Alignment, truth: &Similarity) -> Result<(), Violation> {
    let rule = "moving the target rigidly moves the answer alike";
    let pairs = Pairs::new(truth, 0.004);
    let motion: Pose = Isometry3::new(Vector3::new(-0.7, 0.3, 0.5), Vector3::new(0.3, 1.9, -0.8));
    let mut moved = Pairs::new(truth, 0.004);
    moved.target.iter_mut().for_each(|p| *p = motion * *p);
    let before = answered(rule, || plugin.align(&pairs.view(None)))?.transform;
    let after = answered(rule, || plugin.align(&moved.view(None)))?.transform;
    let error = apart(&pairs, &after, &(motion * before));
    hold(rule, error < SAME, || format!("points are {error:.2e} apart"))
}

fn refuses_what_is_wrong(plugin: &dyn Alignment, truth: &Similarity) -> Result<(), Violation> {
    let whole = || Pairs::new(truth, 0.0);
    let broken = |spoil: &dyn Fn(&mut Pairs)| {
        let mut pairs = whole();
        spoil(&mut pairs);
        plugin.align(&pairs.view(None))
    };
    let cut = |pairs: &mut Pairs, n| {
        pairs.source.truncate(n);
        pairs.target.truncate(n);
        pairs.weights.truncate(n);
    };
    refused("no pairs are refused", || broken(&|p| cut(p, 0)))?;
    refused("one pair is refused", || broken(&|p| cut(p, 1)))?;
    refused("two pairs are refused", || broken(&|p| cut(p, 2)))?;
    for few in [3, 4] {
        let rule = "few pairs are answered or refused";
        answered_or_refused(rule, || broken(&|p| cut(p, few)), AlignmentOutcome::check)?;
    }
    refused("a missing target is refused", || broken(&|p| p.target.truncate(79)))?;
    refused("a missing weight is refused", || broken(&|p| p.weights.truncate(79)))?;
    refused("a NaN source is refused", || broken(&|p| p.source[7].y = f64::NAN))?;
    refused("an infinite target is refused", || broken(&|p| p.target[7].z = f64::INFINITY))?;
    refused("a NaN weight is refused", || broken(&|p| p.weights[7] = f64::NAN))?;
    refused("a negative weight is refused", || broken(&|p| p.weights[7] = -1.0))?;
    refused("weights of zero are refused", || broken(&|p| p.weights.fill(0.0)))?;
    refused("collinear points are refused", || {
        broken(&|p| {
            for (i, (source, target)) in p.source.iter_mut().zip(&mut p.target).enumerate() {
                *source = Point3::new(0.01 * i as f64, 0.0, 0.0);
                *target = truth * *source;
            }
        })
    })?;
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let rule = "a fixed scale that is not positive is refused";
        refused(rule, || plugin.align(&whole().view(Some(scale))))?;
    }
    Ok(())
}
