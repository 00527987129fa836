//! The suite's own arm, and kinematics for it that depend on no plugin.

use crate::{IkOutcome, IkQuery, IkStatus, Kinematics, PluginError};
use nalgebra::{Matrix6, Vector6};
use seeone_core::Pose;
use seeone_core::pose::difference;
use seeone_core::robot::{RobotDescription, RobotModel, RobotOptions};

/// Where the arm waits, radians: bent, the hand in front of it and pointing down.
pub const HOME: [f64; 6] = [0.0, 0.3, 1.5, 0.0, 1.3, 0.0];

/// An arm of six joints with a wrist, at the world's origin, without bodies: nothing that it
/// does touches anything.
///
/// # Panics
/// Never: its description lies beside this file and is tested.
pub fn arm() -> RobotModel {
    let options = RobotOptions { home: Some(HOME.to_vec()), ..RobotOptions::default() };
    let description = RobotDescription { urdf: include_str!("arm.urdf").into(), options };
    RobotModel::from_description(&description).expect("the suite's own arm is sound")
}

/// Where the tool is off a target: metres in `world`, then radians as a rotation vector.
fn miss(at: &Pose, target: &Pose) -> Vector6<f64> {
    let shift = target.translation.vector - at.translation.vector;
    let turn = (target.rotation * at.rotation.inverse()).scaled_axis();
    Vector6::new(shift.x, shift.y, shift.z, turn.x, turn.y, turn.z)
}

/// Damped least squares from where the query starts, and from nowhere else.
#[derive(Clone, Copy, Debug)]
pub struct Descent {
    /// Steps at most.
    pub steps: usize,
    /// The damping, in the units of the Jacobian.
    pub damping: f64,
}

impl Default for Descent {
    fn default() -> Self {
        Self { steps: 200, damping: 0.03 }
    }
}

impl Kinematics for Descent {
    fn solve(&self, robot: &RobotModel, query: &IkQuery) -> Result<IkOutcome, PluginError> {
        query.check(robot)?;
        let mut joints = query.near.to_vec();
        let mut iterations = 0;
        loop {
            let reached = robot.tool_pose(&joints);
            let (position_error_m, rotation_error_rad) = difference(&reached, query.target);
            let solved = position_error_m < 1e-6 && rotation_error_rad < 1e-6;
            if solved || iterations == self.steps {
                let contact = query.clearance.and_then(|clearance| clearance.contact(&joints));
                let reason = match &contact {
                    Some(contact) => Some(contact.to_string()),
                    None if solved => None,
                    None => Some(format!("{:.1} mm are left", position_error_m * 1e3)),
                };
                let status = if solved { IkStatus::Solved } else { IkStatus::Infeasible };
                return Ok(IkOutcome {
                    status,
                    joints,
                    position_error_m,
                    rotation_error_rad,
                    iterations,
                    contact,
                    reason,
                });
            }
            let jacobian = robot.jacobian(&joints);
            let damped: Matrix6<f64> =
                &jacobian * jacobian.transpose() + Matrix6::identity() * self.damping.powi(2);
            let Some(inverse) = damped.try_inverse() else {
                return Err(PluginError::Internal("the damped Jacobian is singular".into()));
            };
            let step = jacobian.transpose() * (inverse * miss(&reached, query.target));
            for ((q, change), joint) in joints.iter_mut().zip(&step).zip(robot.joints()) {
                *q = (*q + change.clamp(-0.2, 0.2)).clamp(joint.lower(), joint.upper());
            }
            iterations += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance;

    #[test]
    fn the_suites_own_kinematics_conform() {
        conformance::kinematics(&Descent::default()).expect("conforms");
    }
}
