//! `my-plugin`, a plugin of kind `motion`: straight lines in joint space, at rest at each end.
//! It looks at no obstacle.

use nalgebra::Translation3;
use seeone_core::Pose;
use seeone_core::robot::RobotModel;
use seeone_plugin::{
    Action, GripperCommand, IkQuery, IkStatus, JointTrajectory, KeyPose, Kinematics, Motion,
    MotionOutcome, MotionTask, PluginError, Program, Setup, Step,
};
use serde::Deserialize;

seeone_plugin::export_plugins! {
    Motion "my-plugin" => MyPlugin::from_setup,
}

/// Plans straight lines. Its fields are its table in a robot file, `[config.motion]`.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MyPlugin {
    /// Share of the largest speed of each joint.
    speed: f64,
}

impl Default for MyPlugin {
    fn default() -> Self {
        Self { speed: 0.3 }
    }
}

/// Seconds a sample.
const PERIOD_S: f64 = 0.008;

impl MyPlugin {
    /// From its table.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for an unknown key or a number out of range.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        let plugin: Self = setup.configuration()?;
        if !(plugin.speed > 0.0 && plugin.speed <= 1.0) {
            let told = format!("speed is {}, not above 0 and up to 1", plugin.speed);
            return Err(PluginError::Configuration(told));
        }
        Ok(plugin)
    }

    /// The line from `from` to `to`, starting and ending at rest (minimum jerk).
    fn line(&self, robot: &RobotModel, from: &[f64], to: &[f64]) -> JointTrajectory {
        let ways = from.iter().zip(to).zip(robot.joints());
        // At its middle a minimum-jerk motion is 15 / 8 as fast as on average, and its largest
        // acceleration is 10 / sqrt(3) of its way over the square of its time, its jerk 60.
        let longest = ways
            .map(|((a, b), joint)| {
                let way = (b - a).abs();
                let by_speed = 15.0 / 8.0 * way / (self.speed * joint.velocity());
                let by_acceleration = (10.0 / 3f64.sqrt() * way / robot.acceleration()).sqrt();
                by_speed.max(by_acceleration).max((60.0 * way / robot.jerk()).cbrt())
            })
            .fold(0.0, f64::max);
        let steps = (longest / PERIOD_S).ceil().max(1.0) as usize;
        let sample = |i: usize| {
            let t = i as f64 / steps as f64;
            let share = t.powi(3) * (10.0 - 15.0 * t + 6.0 * t * t);
            from.iter().zip(to).map(|(a, b)| a + share * (b - a)).collect()
        };
        JointTrajectory { period_s: PERIOD_S, positions: (0..=steps).map(sample).collect() }
    }
}

/// What happens around one key pose: poses to pass, each with what it is for, and what the
/// gripper does.
fn around(key: &KeyPose) -> Vec<(&'static str, Option<Pose>, Option<GripperCommand>)> {
    let along = |metres: f64| key.pose * Translation3::new(0.0, 0.0, metres);
    let lifted = Translation3::new(0.0, 0.0, key.lift_m) * key.pose;
    let mut deeds = Vec::new();
    if matches!(key.gripper, Some(GripperCommand::Close { .. })) {
        let opening_m = key.opening_m;
        deeds.push(("grip", None, Some(GripperCommand::Open { opening_m })));
    }
    if key.approach_m > 0.0 {
        deeds.push(("transit", Some(along(-key.approach_m)), None));
    }
    deeds.push(("approach", Some(key.pose), None));
    deeds.extend(key.gripper.map(|command| ("grip", None, Some(command))));
    if key.lift_m > 0.0 {
        deeds.push(("lift", Some(lifted), None));
    }
    if key.retreat_m > 0.0 {
        deeds.push(("retreat", Some(along(-key.retreat_m)), None));
    }
    deeds
}

impl Motion for MyPlugin {
    fn plan(
        &self,
        robot: &RobotModel,
        kinematics: &dyn Kinematics,
        task: &MotionTask,
    ) -> Result<MotionOutcome, PluginError> {
        task.check(robot)?;
        let mut at = task.start.to_vec();
        let mut program = Program::default();
        let mut cost = 0.0;
        for key in task.key_poses {
            for (purpose, pose, command) in around(key) {
                let action = match (pose, command) {
                    (_, Some(command)) => Action::Grip(command),
                    (None, None) => continue,
                    (Some(pose), None) => {
                        let found = kinematics.solve(robot, &IkQuery::new(&pose, &at))?;
                        if found.status != IkStatus::Solved {
                            let reason = found.reason.unwrap_or_else(|| "no reason".into());
                            let reason = format!("{purpose}: {reason}");
                            return Ok(MotionOutcome::Infeasible {
                                stage: key.stage.clone(),
                                reason,
                            });
                        }
                        let trajectory = self.line(robot, &at, &found.joints);
                        cost +=
                            at.iter().zip(&found.joints).map(|(a, b)| (a - b).abs()).sum::<f64>();
                        at = found.joints;
                        match key.until_contact_n {
                            Some(force_n) if purpose == "approach" => {
                                Action::MoveUntilContact { trajectory, force_n }
                            }
                            _ => Action::Move(trajectory),
                        }
                    }
                };
                program.steps.push(Step { stage: key.stage.clone(), purpose, action });
            }
        }
        Ok(MotionOutcome::Planned { program, cost })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_plugin::conformance;

    #[test]
    fn conforms() {
        conformance::motion(&MyPlugin::default()).expect("conforms");
    }
}
