//! The pose error, the limits and what is near, linearised about a posture.

use nalgebra::{DMatrix, DVector, Matrix6xX, Vector6};
use seeone_core::Pose;
use seeone_core::robot::RobotModel;
use seeone_plugin::Proximity;

/// What a radian of rotation error weighs in metres: about the distance at which the
/// hand holds things.
const RADIAN_M: f64 = 0.25;
/// Pairs of near bodies that one step knows of, the nearest ones.
pub(crate) const PAIRS: usize = 12;
/// What is kept of a pair's margin for the curvature that a linearised step does not see, metres.
const RESERVE_M: f64 = 0.005;
/// The bound of a row that has no pair.
const FREE: f64 = 1.0;

/// One step's problem: `dq` within `lower..upper` and `approach dq <= room` with
/// `jacobian dq` near `error`. Rows 0..3 of the Jacobian are metres, rows 3..6 radians
/// weighed into metres.
pub(crate) struct Linearised {
    pub(crate) jacobian: Matrix6xX<f64>,
    pub(crate) error: Vector6<f64>,
    /// Smallest allowed step, radians.
    pub(crate) lower: DVector<f64>,
    /// Largest allowed step, radians.
    pub(crate) upper: DVector<f64>,
    /// The step to the preferred posture, radians.
    pub(crate) to_posture: DVector<f64>,
    /// How fast each near pair approaches, metres a radian, a row a pair.
    pub(crate) approach: DMatrix<f64>,
    /// How far it may, metres.
    pub(crate) room: DVector<f64>,
}

/// Where a step is taken from and what bounds it.
pub(crate) struct At<'a> {
    pub(crate) robot: &'a RobotModel,
    /// Joint positions, radians, and the poses of the links there.
    pub(crate) q: &'a [f64],
    pub(crate) links: &'a [Pose],
    /// The wanted pose of the tool.
    pub(crate) target: &'a Pose,
    /// The preferred posture, radians.
    pub(crate) posture: &'a [f64],
    /// Smallest and largest position of each joint, radians.
    pub(crate) range: &'a [(f64, f64)],
    /// Largest joint step, radians.
    pub(crate) step_rad: f64,
    /// What is near, the nearest first.
    pub(crate) near: &'a [Proximity],
}

impl Linearised {
    /// Room for the problems of an arm of `joints` joints with `pairs` near pairs.
    pub(crate) fn new(joints: usize, pairs: usize) -> Self {
        Self {
            jacobian: Matrix6xX::zeros(joints),
            error: Vector6::zeros(),
            lower: DVector::zeros(joints),
            upper: DVector::zeros(joints),
            to_posture: DVector::zeros(joints),
            approach: DMatrix::zeros(pairs, joints),
            room: DVector::repeat(pairs, FREE),
        }
    }

    /// Becomes the problem at a posture. Every bound holds for no step at all, so that a step
    /// always exists.
    pub(crate) fn set(&mut self, at: &At) {
        at.robot.jacobian_into(at.links, &mut self.jacobian);
        self.jacobian.rows_mut(3, 3).scale_mut(RADIAN_M);
        let tool = at.links[at.q.len()] * at.robot.tool();
        self.error = twist(&tool, at.target);
        self.error.fixed_rows_mut::<3>(3).scale_mut(RADIAN_M);
        for (i, (q, (low, high))) in at.q.iter().zip(at.range).enumerate() {
            self.lower[i] = (low - q).clamp(-at.step_rad, 0.0);
            self.upper[i] = (high - q).clamp(0.0, at.step_rad);
            self.to_posture[i] = at.posture[i] - q;
        }
        self.approach.fill(0.0);
        self.room.fill(FREE);
        for (row, near) in at.near.iter().take(self.room.len()).enumerate() {
            // What is too near already may come no nearer.
            self.room[row] = (near.margin_m - RESERVE_M).max(0.0);
            for (carrier, sense) in near.carriers.iter().zip([1.0, -1.0]) {
                let Some((link, point)) = carrier else { continue };
                for i in 0..*link {
                    let joint = &at.links[i + 1];
                    let axis = joint * at.robot.joints()[i].axis().into_inner();
                    let velocity = axis.cross(&(point.coords - joint.translation.vector));
                    self.approach[(row, i)] += sense * near.normal.dot(&velocity);
                }
            }
        }
    }

    /// Whether `step` keeps every bound.
    pub(crate) fn allows(&self, step: &DVector<f64>) -> bool {
        let inside = |i: usize| (self.lower[i]..=self.upper[i]).contains(&step[i]);
        (0..step.len()).all(inside)
            && (0..self.room.len()).all(|row| self.approach.row(row).tr_dot(step) <= self.room[row])
    }
}

/// The motion from `from` to `to`: metres, then the rotation vector, both in `world`.
pub(crate) fn twist(from: &Pose, to: &Pose) -> Vector6<f64> {
    let linear = to.translation.vector - from.translation.vector;
    let angular = (to.rotation * from.rotation.inverse()).scaled_axis();
    Vector6::new(linear.x, linear.y, linear.z, angular.x, angular.y, angular.z)
}
