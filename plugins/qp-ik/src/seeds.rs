//! Where descents start.

use crate::ClosedForm;
use seeone_core::Pose;
use seeone_core::random::{generator, uniform};
use seeone_core::robot::RobotModel;
use std::f64::consts::TAU;

/// What coming within a radian of a joint limit costs, in square radians of joint travel.
const LIMIT_COST: f64 = 0.2;

/// The closed form's solutions within the limits, each joint at the whole turn nearest to
/// `near`, the best first.
pub(crate) fn closed_form(
    geometry: &ClosedForm,
    robot: &RobotModel,
    target: &Pose,
    near: &[f64],
) -> Vec<Vec<f64>> {
    let solutions = geometry.solve(target, near).into_iter();
    let mut seeds: Vec<(f64, Vec<f64>)> = solutions
        .filter_map(|q| within_turns(robot, &q, near))
        .map(|q| (cost(robot, &q, near), q))
        .collect();
    seeds.sort_by(|a, b| a.0.total_cmp(&b.0));
    seeds.into_iter().map(|(_, q)| q).collect()
}

/// Seeded draws within the limits, the same for every target.
pub(crate) fn random(robot: &RobotModel, seed: u64, count: usize) -> Vec<Vec<f64>> {
    let mut rng = generator(seed, "kinematics");
    let mut draw =
        || robot.joints().iter().map(|j| uniform(&mut rng, j.lower(), j.upper())).collect();
    (0..count).map(|_| draw()).collect()
}

/// Joint travel from `near`, squared, and closeness to limits.
pub(crate) fn cost(robot: &RobotModel, q: &[f64], near: &[f64]) -> f64 {
    let joints = robot.joints().iter().zip(q.iter().zip(near));
    joints
        .map(|(joint, (q, near))| {
            let margin = (q - joint.lower()).min(joint.upper() - q);
            (q - near).powi(2) + LIMIT_COST * (1.0 - margin).max(0.0).powi(2)
        })
        .sum()
}

/// `q` with each joint turned by whole turns to where it is allowed and nearest to `near`;
/// `None` when a joint has no such position.
fn within_turns(robot: &RobotModel, q: &[f64], near: &[f64]) -> Option<Vec<f64>> {
    let joints = robot.joints().iter().zip(q.iter().zip(near));
    joints
        .map(|(joint, (q, near))| {
            let nearest = q + TAU * ((near - q) / TAU).round();
            [nearest, nearest - TAU, nearest + TAU]
                .into_iter()
                .filter(|position| joint.allows(*position))
                .min_by(|a, b| (a - near).abs().total_cmp(&(b - near).abs()))
        })
        .collect()
}
