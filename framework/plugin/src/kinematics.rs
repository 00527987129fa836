//! Kind `kinematics`: joint positions that bring the tool to a pose.

use crate::{Clearance, Contact, PluginError};
use seeone_core::Pose;
use seeone_core::robot::RobotModel;

/// One inverse kinematics problem.
#[derive(Clone, Copy)]
pub struct IkQuery<'a> {
    /// Wanted pose of the tool frame (TCP) in `world`.
    pub target: &'a Pose,
    /// Where to start and stay near, radians, one a joint.
    pub near: &'a [f64],
    /// Whether the answer must be on the branch continuous with `near` (path following)
    /// or may be any.
    pub continuous: bool,
    /// The time since the arm was at `near`, seconds, in which no joint moves further than
    /// its largest speed allows; `None` when it may take as long as it likes.
    pub period_s: Option<f64>,
    /// What to keep away from: among several answers one that touches nothing is chosen, and
    /// an answer that touches something says so.
    pub clearance: Option<&'a dyn Clearance>,
}

impl<'a> IkQuery<'a> {
    /// Any answer, near `near`.
    pub fn new(target: &'a Pose, near: &'a [f64]) -> Self {
        Self { target, near, continuous: false, period_s: None, clearance: None }
    }

    /// Refuses what no posture can be sought for or from, so that every implementation refuses
    /// alike.
    ///
    /// # Errors
    /// [`PluginError::Input`] for a pose that is not finite, a period that is no time, a wrong
    /// joint count, or a start that is not finite or outside the limits.
    pub fn check(&self, robot: &RobotModel) -> Result<(), PluginError> {
        let told = |cause: String| Err(PluginError::Input(cause));
        if !self.target.to_homogeneous().iter().all(|v| v.is_finite()) {
            return told("the target pose is not finite".into());
        }
        if self.period_s.is_some_and(|period| !(period.is_finite() && period > 0.0)) {
            return told("the period is no time".into());
        }
        let (given, wanted) = (self.near.len(), robot.joints().len());
        if given != wanted {
            return told(format!("the start has {given} positions, the arm {wanted} joints"));
        }
        let mut joints = robot.joints().iter().zip(self.near);
        match joints.find(|(joint, q)| !joint.allows(**q)) {
            None => Ok(()),
            Some((joint, q)) if q.is_finite() => told(format!(
                "the start: {} at {q:.4} rad is outside {:.4}..{:.4}",
                joint.name(),
                joint.lower(),
                joint.upper()
            )),
            Some((joint, _)) => told(format!("the start: {} is not finite", joint.name())),
        }
    }

    /// The answer on the branch continuous with `near`.
    pub fn continuous(target: &'a Pose, near: &'a [f64]) -> Self {
        Self { continuous: true, ..Self::new(target, near) }
    }
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
    /// What the arm touches there, of what the query asked to keep away from.
    pub contact: Option<Contact>,
    /// Why it is not solved, or touches something.
    pub reason: Option<String>,
}

impl IkOutcome {
    /// Says what no kinematics may answer for `robot`.
    ///
    /// # Errors
    /// A sentence about joints that are not the robot's or not within its limits, errors that
    /// are no lengths, or a failure without a reason.
    pub fn check(&self, robot: &RobotModel) -> Result<(), String> {
        if !robot.within_limits(&self.joints) {
            let limits = "one position within the limits for each joint";
            return Err(format!("{:?} is not {limits}", self.joints));
        }
        let errors = [self.position_error_m, self.rotation_error_rad];
        if !errors.iter().all(|e| e.is_finite() && *e >= 0.0) {
            return Err(format!("the remaining errors are {errors:?}"));
        }
        if self.status == IkStatus::Infeasible && self.reason.is_none() {
            return Err("it found no solution and gives no reason".into());
        }
        Ok(())
    }
}

/// Tool pose -> joint positions.
pub trait Kinematics: Send + Sync {
    /// Solves one problem.
    ///
    /// # Errors
    /// [`PluginError::Input`] for a pose that is not finite, a wrong joint count, or a start
    /// that is not finite or outside the limits.
    fn solve(&self, robot: &RobotModel, query: &IkQuery) -> Result<IkOutcome, PluginError>;
}
