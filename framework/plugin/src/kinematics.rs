//! Kind `kinematics`: joint positions that bring the tool to a pose.

use crate::PluginError;
use seeone_core::Pose;
use seeone_core::robot::RobotModel;

/// One inverse kinematics problem.
#[derive(Clone, Copy, Debug)]
pub struct IkQuery<'a> {
    /// Wanted pose of the tool frame (TCP) in `world`.
    pub target: &'a Pose,
    /// Where to start and stay near, radians, one a joint.
    pub near: &'a [f64],
    /// Whether the answer must be on the branch continuous with `near` (path following)
    /// or may be any.
    pub continuous: bool,
}

/// How a solver ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IkStatus {
    /// Within 1 mm and 0.01 rad and within the limits.
    Solved,
    /// The best found is outside the tolerance.
    Infeasible,
}

/// What a kinematics plugin found.
#[derive(Clone, Debug, PartialEq)]
pub struct IkOutcome {
    /// How it ended.
    pub status: IkStatus,
    /// The best joint positions, radians, always within the limits.
    pub joints: Vec<f64>,
    /// Remaining position error, metres.
    pub position_error_m: f64,
    /// Remaining rotation error, radians.
    pub rotation_error_rad: f64,
    /// Steps taken.
    pub iterations: usize,
    /// Why it is not solved.
    pub reason: Option<String>,
}

/// Tool pose -> joint positions.
pub trait Kinematics: Send + Sync {
    /// Solves one problem.
    ///
    /// # Errors
    /// [`PluginError::Input`] for a pose that is not finite or a wrong joint count.
    fn solve(&self, robot: &RobotModel, query: &IkQuery) -> Result<IkOutcome, PluginError>;
}
