//! Straight lines of the tool on one branch of the arm.

use crate::failure::Failure;
use nalgebra::Translation3;
use seeone_core::Pose;
use seeone_core::pose::difference;
use seeone_core::robot::RobotModel;
use seeone_plugin::{IkQuery, IkStatus, Kinematics};

/// Largest joint step between two poses of a line, radians: a larger one is a jump to
/// another branch or a passage through a singularity.
const JUMP_RAD: f64 = 0.25;
/// Largest turn between two poses of a line, radians.
const TURN_RAD: f64 = 0.05;

/// Follows a straight line (and the shortest turn) from the tool's pose at `start` to
/// `target` in steps of at most `step_m`. `fault` says what is wrong with a posture.
/// Gives the postures, `start` first.
///
/// # Errors
/// How far the line can be followed and why no further.
pub(crate) fn follow(
    robot: &RobotModel,
    kinematics: &dyn Kinematics,
    start: &[f64],
    target: &Pose,
    step_m: f64,
    fault: &dyn Fn(&[f64]) -> Option<String>,
) -> Result<Vec<Vec<f64>>, Failure> {
    let from = robot.tool_pose(start);
    let (length, turn) = difference(&from, target);
    let steps = (length / step_m).max(turn / TURN_RAD).ceil().max(1.0);
    let mut path = vec![start.to_vec()];
    for k in 1..=steps as usize {
        let share = k as f64 / steps;
        let far =
            || format!("{:.0} of {:.0} mm along the line", 1e3 * share * length, 1e3 * length);
        let pose = between(&from, target, share);
        let near = continued(robot, &path);
        let query = IkQuery::continuous(&pose, &near);
        let found = kinematics.solve(robot, &query)?;
        if found.status != IkStatus::Solved {
            let why = found.reason.unwrap_or_else(|| "no posture".into());
            return Err(Failure::Infeasible(format!("{}: {why}", far())));
        }
        let before = &path[path.len() - 1];
        let jumps = robot.joints().iter().zip(found.joints.iter().zip(before));
        let jump = jumps.map(|(joint, (a, b))| ((a - b).abs(), joint.name()));
        if let Some((jump, joint)) = jump.max_by(|a, b| a.0.total_cmp(&b.0))
            && jump > JUMP_RAD
        {
            return Err(Failure::Infeasible(format!(
                "{}: {joint} would jump by {jump:.2} rad",
                far()
            )));
        }
        if let Some(why) = fault(&found.joints) {
            return Err(Failure::Infeasible(format!("{}: {why}", far())));
        }
        path.push(found.joints);
    }
    Ok(path)
}

/// The pose `share` of the way along a straight line and the shortest turn.
fn between(from: &Pose, to: &Pose, share: f64) -> Pose {
    let at = from.translation.vector.lerp(&to.translation.vector, share);
    let turn = (from.rotation.inverse() * to.rotation).scaled_axis() * share;
    Pose::from_parts(Translation3::from(at), from.rotation * nalgebra::UnitQuaternion::new(turn))
}

/// Where the joints will be if they go on as they went: the nearer the guess, the fewer
/// steps the solver takes.
fn continued(robot: &RobotModel, path: &[Vec<f64>]) -> Vec<f64> {
    let last = &path[path.len() - 1];
    let before = &path[path.len().saturating_sub(2)];
    let joints = robot.joints().iter().zip(last.iter().zip(before));
    joints.map(|(joint, (a, b))| (2.0 * a - b).clamp(joint.lower(), joint.upper())).collect()
}
