//! Whether a demonstrated hand took anything.

use crate::files::Skill;
use nalgebra::{Point3, distance};
use seeone_core::Cloud;

/// The pads of a closed hand hold what is within so many metres of the tool's point.
const PADS_M: f64 = 0.025;
/// Of what was held, so many points at least were seen.
const LEAST_POINTS: usize = 3;

/// Checks that the first stage of `skill`, which takes the object, takes some of `shown`, the cloud
/// of its demonstration.
///
/// # Errors
/// A sentence about how far from the hand the cloud is.
pub fn takes(skill: &Skill, shown: &Cloud) -> Result<(), String> {
    let Some(first) = skill.stages.first() else { return Ok(()) };
    let tool = Point3::from(first.gripper_pose.translation.vector);
    let distances = || shown.points().iter().map(|point| distance(point, &tool));
    if distances().filter(|metres| *metres <= PADS_M).count() >= LEAST_POINTS {
        return Ok(());
    }
    let nearest = distances().fold(f64::INFINITY, f64::min);
    let away = match nearest.is_finite() {
        true => format!("the nearest is {:.0} mm away", nearest * 1e3),
        false => "it has none".to_owned(),
    };
    let stage = &first.name;
    Err(format!("stage {stage:?} of the demonstration closes on no points of its cloud: {away}"))
}
