//! Descent on the pose error from one start.

use crate::IkConfig;
use crate::linearised::Linearised;
use nalgebra::DVector;
use seeone_core::Pose;
use seeone_core::pose::difference;
use seeone_core::robot::RobotModel;

/// The tolerance of the contract.
pub(crate) const POSITION_TOLERANCE_M: f64 = 1e-3;
/// The tolerance of the contract.
pub(crate) const ROTATION_TOLERANCE_RAD: f64 = 1e-2;
/// What the descent aims at, as a share of the tolerance: a path of such postures is
/// within 0.02 mm of its line.
const AIM: f64 = 0.02;
/// It gives up when the error has not fallen by a hundredth over this many steps.
const PATIENCE: usize = 8;

/// Something that takes one step.
pub(crate) trait Step: Send + Sync {
    /// From the configuration.
    fn new(config: &IkConfig) -> Self;

    /// The step in radians, within the problem's limits but for rounding; `None` when the
    /// numbers do not allow one.
    fn step(&self, problem: &Linearised) -> Option<DVector<f64>>;
}

/// A posture and how far its tool is from the target.
#[derive(Clone, Debug)]
pub(crate) struct Posture {
    pub(crate) joints: Vec<f64>,
    pub(crate) position_error_m: f64,
    pub(crate) rotation_error_rad: f64,
}

impl Posture {
    pub(crate) fn new(robot: &RobotModel, joints: Vec<f64>, target: &Pose) -> Self {
        let (position_error_m, rotation_error_rad) = difference(&robot.tool_pose(&joints), target);
        Self { joints, position_error_m, rotation_error_rad }
    }

    /// The error in units of the tolerance: at most one is solved.
    pub(crate) fn error(&self) -> f64 {
        let position = self.position_error_m / POSITION_TOLERANCE_M;
        position.max(self.rotation_error_rad / ROTATION_TOLERANCE_RAD)
    }
}

/// Descends from `start`, which must be within the limits; gives the best posture met and
/// the number of steps.
pub(crate) fn descend(
    robot: &RobotModel,
    target: &Pose,
    start: &[f64],
    step: &impl Step,
    config: &IkConfig,
) -> (Posture, usize) {
    let mut at = Posture::new(robot, start.to_vec(), target);
    let mut best = at.clone();
    let mut waited = 0;
    for iteration in 0..config.max_iterations {
        if best.error() <= AIM || waited >= PATIENCE {
            return (best, iteration);
        }
        let problem = Linearised::at(robot, &at.joints, target, start, config.step_rad);
        let Some(step) = step.step(&problem) else {
            return (best, iteration);
        };
        let moved = robot.joints().iter().zip(at.joints.iter().zip(step.iter()));
        let joints = moved.map(|(j, (q, d))| (q + d).clamp(j.lower(), j.upper())).collect();
        at = Posture::new(robot, joints, target);
        waited = if at.error() < 0.99 * best.error() { 0 } else { waited + 1 };
        if at.error() < best.error() {
            best = at.clone();
        }
    }
    (best, config.max_iterations)
}
