//! The rules of kind `perception`.

use super::violation::{Violation, answered, answered_or_refused, hold, refused, sound};
use crate::{CanonicalCloud, Observation, Perception};
use nalgebra::{Point3, Vector3};
use seeone_core::random::{direction, generator};
use seeone_core::{Cloud, Pose};

/// How far a rigid move may change a canonical coordinate on average.
const STEADY: f64 = 0.05;

/// What a camera might see of a cap: `count` points of a dome on a table, with a visor towards
/// the camera.
///
/// # Panics
/// Never: its points are finite.
pub fn observation(count: usize) -> Observation {
    let mut rng = generator(0, "conformance-perception");
    let points = (0..count).map(|i| {
        let d = direction(&mut rng);
        if i % 5 == 0 {
            Point3::new(0.5 + 0.06 * d.x, -0.1 - 0.06 * d.y.abs(), 0.02 + 0.004 * d.z)
        } else {
            Point3::new(0.5 + 0.085 * d.x, 0.1 * d.y, 0.01 + 0.12 * d.z.abs())
        }
    });
    let cloud = Cloud::new(points.collect()).expect("finite points");
    Observation { depth: None, cloud, camera_position: Point3::new(0.5, -0.6, 0.7) }
}

/// The same seen somewhere else.
fn moved(observation: &Observation, motion: &Pose) -> Observation {
    let points = observation.cloud.points().iter().map(|p| motion * p).collect();
    let camera_position = motion * observation.camera_position;
    Observation { depth: None, cloud: Cloud::new(points).unwrap_or_default(), camera_position }
}

/// Holds every rule of the kind.
///
/// # Errors
/// The first rule that `plugin` breaks.
pub fn perception(plugin: &mut dyn Perception) -> Result<(), Violation> {
    let rule = "finite in, finite and within its range out";
    let seen = observation(1500);
    let found = answered(rule, || plugin.perceive(&seen))?;
    sound(rule, found.check())?;
    hold("something is perceived", !found.is_empty(), || "no point".into())?;
    let of_the_cloud = |p: &Point3<f64>| seen.cloud.points().contains(p);
    let rule = "what is perceived are points that were seen";
    hold(rule, found.points.iter().all(of_the_cloud), || "another point".into())?;

    let rule = "the same input gives the same bytes";
    let again = answered(rule, || plugin.perceive(&seen))?;
    hold(rule, found == again, || "two answers differ".into())?;

    let rule = "a move over the table with the camera leaves the canonical coordinates";
    let motion = Pose::new(Vector3::new(0.2, -0.3, 0.0), Vector3::new(0.0, 0.0, 1.1));
    let there = answered(rule, || plugin.perceive(&moved(&seen, &motion)))?;
    let change = change(&found, &there, &motion);
    hold(rule, change < STEADY, || format!("{change:.3} of the cube on average"))?;

    refused("an empty cloud is refused", || plugin.perceive(&observation(0)))?;
    for count in [1, 2, 3, 10] {
        let rule = "few points are answered or refused";
        answered_or_refused(rule, || plugin.perceive(&observation(count)), CanonicalCloud::check)?;
    }
    Ok(())
}

/// Mean change of the canonical coordinates of the points that both hold.
fn change(before: &CanonicalCloud, after: &CanonicalCloud, motion: &Pose) -> f64 {
    let (mut sum, mut common) = (0.0, 0usize);
    for (point, nocs) in before.points.iter().zip(&before.nocs) {
        let there = motion * point;
        let same = after.points.iter().position(|p| (p - there).norm() < 1e-9);
        if let Some(row) = same {
            sum += (after.nocs[row] - nocs).norm();
            common += 1;
        }
    }
    if common == 0 { f64::INFINITY } else { sum / common as f64 }
}
