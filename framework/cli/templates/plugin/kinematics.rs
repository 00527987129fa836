//! `my-plugin`, a plugin of kind `kinematics`: damped least squares from where the arm is.

use nalgebra::{Matrix6, Vector6};
use seeone_core::Pose;
use seeone_core::pose::difference;
use seeone_core::robot::RobotModel;
use seeone_plugin::{IkOutcome, IkQuery, IkStatus, Kinematics, PluginError, Setup};
use serde::Deserialize;

seeone_plugin::export_plugins! {
    Kinematics "my-plugin" => MyPlugin::from_setup,
}

/// Solves by damped least squares. Its fields are its table in a robot file,
/// `[config.kinematics]`.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MyPlugin {
    /// Steps at most.
    steps: usize,
    /// The damping, in the units of the Jacobian.
    damping: f64,
}

impl Default for MyPlugin {
    fn default() -> Self {
        Self { steps: 200, damping: 0.03 }
    }
}

/// Where the search ends: metres and radians.
const SOLVED: f64 = 1e-6;
/// The largest change of a joint in one step, radians.
const STEP_RAD: f64 = 0.2;

impl MyPlugin {
    /// From its table.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for an unknown key or a number out of range.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        let plugin: Self = setup.configuration()?;
        if plugin.steps == 0 || !(plugin.damping > 0.0 && plugin.damping.is_finite()) {
            let told = format!("{plugin:?}: steps is at least 1, damping above 0");
            return Err(PluginError::Configuration(told));
        }
        Ok(plugin)
    }
}

/// Where the tool is off its target: metres in `world`, then a rotation vector in radians.
fn miss(at: &Pose, target: &Pose) -> Vector6<f64> {
    let shift = target.translation.vector - at.translation.vector;
    let turn = (target.rotation * at.rotation.inverse()).scaled_axis();
    Vector6::new(shift.x, shift.y, shift.z, turn.x, turn.y, turn.z)
}

impl Kinematics for MyPlugin {
    fn solve(&self, robot: &RobotModel, query: &IkQuery) -> Result<IkOutcome, PluginError> {
        query.check(robot)?;
        let mut joints = query.near.to_vec();
        let mut iterations = 0;
        let (metres, radians) = loop {
            let reached = robot.tool_pose(&joints);
            let (metres, radians) = difference(&reached, query.target);
            if metres.max(radians) < SOLVED || iterations == self.steps {
                break (metres, radians);
            }
            iterations += 1;
            let jacobian = robot.jacobian(&joints);
            let damped: Matrix6<f64> =
                &jacobian * jacobian.transpose() + Matrix6::identity() * self.damping.powi(2);
            let Some(inverse) = damped.try_inverse() else { break (metres, radians) };
            let step = jacobian.transpose() * (inverse * miss(&reached, query.target));
            for ((q, change), joint) in joints.iter_mut().zip(&step).zip(robot.joints()) {
                let moved = *q + change.clamp(-STEP_RAD, STEP_RAD);
                *q = moved.clamp(joint.lower(), joint.upper());
            }
        };
        let solved = metres.max(radians) < SOLVED;
        let contact = query.clearance.and_then(|clearance| clearance.contact(&joints));
        let reason = match &contact {
            _ if !solved => Some(format!("{:.1} mm and {radians:.3} rad are left", metres * 1e3)),
            Some(contact) => Some(contact.to_string()),
            None => None,
        };
        Ok(IkOutcome {
            status: if solved { IkStatus::Solved } else { IkStatus::Infeasible },
            joints,
            position_error_m: metres,
            rotation_error_rad: radians,
            iterations,
            contact,
            reason,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_plugin::conformance;

    #[test]
    fn conforms() {
        conformance::kinematics(&MyPlugin::default()).expect("conforms");
    }
}
