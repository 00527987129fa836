//! The pose error and its linearisation about a posture.

use nalgebra::{DVector, Matrix6xX, Vector6};
use seeone_core::Pose;
use seeone_core::robot::RobotModel;

/// What a radian of rotation error weighs in metres: about the distance at which the
/// hand holds things.
const RADIAN_M: f64 = 0.25;

/// One step's problem: `dq` within `lower..upper` with `jacobian dq` near `error`.
/// Rows 0..3 are metres, rows 3..6 radians weighed into metres.
pub(crate) struct Linearised {
    pub(crate) jacobian: Matrix6xX<f64>,
    pub(crate) error: Vector6<f64>,
    /// Smallest allowed step, radians.
    pub(crate) lower: DVector<f64>,
    /// Largest allowed step, radians.
    pub(crate) upper: DVector<f64>,
    /// The step to the preferred posture, radians.
    pub(crate) to_posture: DVector<f64>,
}

impl Linearised {
    /// The problem at `q` towards `target`, joint steps at most `step_rad`.
    pub(crate) fn at(
        robot: &RobotModel,
        q: &[f64],
        target: &Pose,
        posture: &[f64],
        step_rad: f64,
    ) -> Self {
        let mut jacobian = robot.jacobian(q);
        jacobian.rows_mut(3, 3).scale_mut(RADIAN_M);
        let mut error = twist(&robot.tool_pose(q), target);
        error.fixed_rows_mut::<3>(3).scale_mut(RADIAN_M);
        let joints = robot.joints().iter().zip(q);
        // Within the limits both bounds hold zero, so a step always exists.
        let lower = joints.clone().map(|(joint, q)| (joint.lower() - q).clamp(-step_rad, 0.0));
        let upper = joints.map(|(joint, q)| (joint.upper() - q).clamp(0.0, step_rad));
        Self {
            jacobian,
            error,
            lower: DVector::from_iterator(q.len(), lower),
            upper: DVector::from_iterator(q.len(), upper),
            to_posture: DVector::from_iterator(q.len(), posture.iter().zip(q).map(|(p, q)| p - q)),
        }
    }
}

/// The motion from `from` to `to`: metres, then the rotation vector, both in `world`.
pub(crate) fn twist(from: &Pose, to: &Pose) -> Vector6<f64> {
    let linear = to.translation.vector - from.translation.vector;
    let angular = (to.rotation * from.rotation.inverse()).scaled_axis();
    Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
}
