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

/// How often the step is halved where a joint would jump.
const HALVINGS: u32 = 3;

/// A straight line (and the shortest turn) to be followed.
pub(crate) struct Line<'a> {
    pub(crate) robot: &'a RobotModel,
    pub(crate) kinematics: &'a dyn Kinematics,
    /// The posture at its beginning, radians.
    pub(crate) start: &'a [f64],
    /// The tool's pose at its end.
    pub(crate) target: &'a Pose,
    /// Largest step between two postures, metres.
    pub(crate) step_m: f64,
    /// What is wrong with a posture.
    pub(crate) fault: &'a dyn Fn(&[f64]) -> Option<String>,
}

/// Why a line ends before its end.
enum Stop {
    /// A joint would jump: shorter steps may do.
    Jump(String),
    /// For good.
    Failure(Failure),
}

impl Line<'_> {
    /// The postures along the line at equal distances, the start first. Where a joint would
    /// jump, the line is followed again in steps half as long: a jump to another branch stays
    /// one, a quick turn near a singularity does not.
    ///
    /// # Errors
    /// How far the line can be followed and why no further.
    pub(crate) fn follow(&self) -> Result<Vec<Vec<f64>>, Failure> {
        let from = self.robot.tool_pose(self.start);
        let (length, turn) = difference(&from, self.target);
        let steps = (length / self.step_m).max(turn / TURN_RAD).ceil().max(1.0) as usize;
        let mut jump = String::new();
        for halving in 0..=HALVINGS {
            match self.in_steps(steps << halving, &from, length) {
                Ok(path) => return Ok(path),
                Err(Stop::Jump(reason)) => jump = reason,
                Err(Stop::Failure(failure)) => return Err(failure),
            }
        }
        Err(Failure::Infeasible(jump))
    }

    fn in_steps(&self, steps: usize, from: &Pose, length: f64) -> Result<Vec<Vec<f64>>, Stop> {
        let robot = self.robot;
        let mut path = vec![self.start.to_vec()];
        for k in 1..=steps {
            let share = k as f64 / steps as f64;
            let told = |why: String| {
                format!(
                    "{:.0} of {:.0} mm along the line: {why}",
                    1e3 * share * length,
                    1e3 * length
                )
            };
            let end = |why: String| Err(Stop::Failure(Failure::Infeasible(told(why))));
            let pose = between(from, self.target, share);
            let near = continued(robot, &path);
            let query = IkQuery::continuous(&pose, &near);
            let found =
                self.kinematics.solve(robot, &query).map_err(|e| Stop::Failure(e.into()))?;
            if found.status != IkStatus::Solved {
                return end(found.reason.unwrap_or_else(|| "no posture".into()));
            }
            let before = &path[path.len() - 1];
            let jumps = robot.joints().iter().zip(found.joints.iter().zip(before));
            let jump = jumps.map(|(joint, (a, b))| ((a - b).abs(), joint.name()));
            if let Some((jump, joint)) = jump.max_by(|a, b| a.0.total_cmp(&b.0))
                && jump > JUMP_RAD
            {
                return Err(Stop::Jump(told(format!("{joint} would jump by {jump:.2} rad"))));
            }
            if let Some(why) = (self.fault)(&found.joints) {
                return end(why);
            }
            path.push(found.joints);
        }
        Ok(path)
    }
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use seeone_core::robot::RobotOptions;
    use seeone_plugin::{IkOutcome, PluginError};
    use std::path::Path;

    /// The first joint turns by so much for each metre of the tool's height.
    struct Quick(f64);

    impl Kinematics for Quick {
        fn solve(&self, _: &RobotModel, query: &IkQuery) -> Result<IkOutcome, PluginError> {
            let mut joints = START.to_vec();
            joints[0] =
                self.0 * (query.target.translation.z - ur5().tool_pose(&START).translation.z);
            Ok(IkOutcome {
                status: IkStatus::Solved,
                joints,
                position_error_m: 0.0,
                rotation_error_rad: 0.0,
                iterations: 0,
                contact: None,
                reason: None,
            })
        }
    }

    const START: [f64; 6] = [0.0, -1.9, 1.9, -1.57, -1.57, 0.0];

    fn ur5() -> RobotModel {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/ur5-ag95.urdf");
        RobotModel::from_urdf(&file, &RobotOptions::default()).unwrap()
    }

    fn follow(quick: f64) -> Result<Vec<Vec<f64>>, Failure> {
        let robot = ur5();
        let mut target = robot.tool_pose(&START);
        target.translation.z += 0.02;
        let line = Line {
            robot: &robot,
            kinematics: &Quick(quick),
            start: &START,
            target: &target,
            step_m: 0.005,
            fault: &|_| None,
        };
        line.follow()
    }

    #[test]
    fn the_step_is_halved_where_a_joint_would_jump_and_a_jump_stays_one() {
        assert_eq!(follow(40.0).unwrap().len(), 5, "0.2 rad a step");
        assert_eq!(follow(80.0).unwrap().len(), 9, "0.4 rad a step, 0.2 rad a half step");
        assert_eq!(follow(300.0).unwrap().len(), 33);
        let told = follow(1000.0).unwrap_err().to_string();
        assert!(told.contains("shoulder_pan_joint would jump by 0.62 rad"), "{told}");
        assert!(told.starts_with("1 of 20 mm along the line"), "{told}");
    }
}
