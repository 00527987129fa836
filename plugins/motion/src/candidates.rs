//! The branches on which the arm can reach a pose.

use crate::failure::Failure;
use seeone_core::Pose;
use seeone_core::random::{generator, uniform};
use seeone_core::robot::RobotModel;
use seeone_plugin::{IkQuery, IkStatus, Kinematics};
use std::f64::consts::TAU;

/// Postures nearer than this are one branch, radians.
const SAME_RAD: f64 = 0.1;
/// Questions asked for each branch wanted.
const QUESTIONS: usize = 4;

/// Up to `count` postures that bring the tool to `target`, the nearest to `near` first.
/// The kinematics is asked from `near` and then from seeded
/// postures all over the joints' range.
///
/// # Errors
/// By how much the target is out of reach, when no posture reaches it.
pub(crate) fn candidates(
    robot: &RobotModel,
    kinematics: &dyn Kinematics,
    target: &Pose,
    near: &[f64],
    count: usize,
) -> Result<Vec<Vec<f64>>, Failure> {
    let first = kinematics.solve(robot, &IkQuery::new(target, near))?;
    if first.status != IkStatus::Solved {
        return Err(Failure::Infeasible(
            first.reason.unwrap_or_else(|| "no posture reaches it".into()),
        ));
    }
    let mut found = vec![first.joints];
    let mut rng = generator(0, "branches");
    for _ in 0..QUESTIONS * count {
        if found.len() >= count {
            break;
        }
        let near_by: Vec<f64> =
            robot.joints().iter().map(|j| uniform(&mut rng, j.lower(), j.upper())).collect();
        let query = IkQuery::new(target, &near_by);
        let outcome = kinematics.solve(robot, &query)?;
        let joints = turned_towards(robot, &outcome.joints, near);
        let known = found.iter().any(|q| furthest(q, &joints) < SAME_RAD);
        if outcome.status == IkStatus::Solved && !known {
            found.push(joints);
        }
    }
    found.sort_by(|a, b| cost(robot, a, near).total_cmp(&cost(robot, b, near)));
    Ok(found)
}

/// Joint travel from `near` and closeness to limits; smaller is better.
pub(crate) fn cost(robot: &RobotModel, q: &[f64], near: &[f64]) -> f64 {
    q.iter().zip(near).map(|(a, b)| (a - b).abs()).sum::<f64>() + limit_cost(robot, q)
}

/// One for each joint at its limit, falling to zero half a radian away from it.
pub(crate) fn limit_cost(robot: &RobotModel, q: &[f64]) -> f64 {
    let margins = robot.joints().iter().zip(q).map(|(j, q)| (q - j.lower()).min(j.upper() - q));
    margins.map(|margin| (1.0 - 2.0 * margin).max(0.0)).sum()
}

/// `q` with every joint at the allowed whole turn nearest to `near`.
fn turned_towards(robot: &RobotModel, q: &[f64], near: &[f64]) -> Vec<f64> {
    let joints = robot.joints().iter().zip(q.iter().zip(near));
    joints
        .map(|(joint, (q, near))| {
            let turned = q + TAU * ((near - q) / TAU).round();
            if joint.allows(turned) { turned } else { *q }
        })
        .collect()
}

fn furthest(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}
