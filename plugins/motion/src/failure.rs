//! Why something cannot be planned.

use seeone_plugin::{MotionOutcome, PluginError};
use std::fmt;

/// Why a line, a transit or a posture is not to be had.
#[derive(Debug)]
pub(crate) enum Failure {
    /// The task does not allow it; told to the user.
    Infeasible(String),
    /// The kinematics could not work on it.
    Plugin(PluginError),
}

/// A failure and the stage it belongs to.
#[derive(Debug)]
pub(crate) struct StageFailure {
    stage: String,
    failure: Failure,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Infeasible(reason) => write!(f, "{reason}"),
            Self::Plugin(error) => write!(f, "{error}"),
        }
    }
}

impl From<PluginError> for Failure {
    fn from(error: PluginError) -> Self {
        Self::Plugin(error)
    }
}

impl Failure {
    /// The same failure of `what` at `stage`.
    pub(crate) fn at(self, stage: &str, what: &str) -> StageFailure {
        let failure = match self {
            Self::Infeasible(reason) => Self::Infeasible(format!("{what}: {reason}")),
            Self::Plugin(error) => Self::Plugin(error),
        };
        StageFailure { stage: stage.to_owned(), failure }
    }
}

impl StageFailure {
    /// Whether another branch of the arm may do better.
    pub(crate) fn is_infeasible(&self) -> bool {
        matches!(self.failure, Failure::Infeasible(_))
    }

    /// What the planner answers.
    ///
    /// # Errors
    /// The kinematics' error.
    pub(crate) fn outcome(self) -> Result<MotionOutcome, PluginError> {
        match self.failure {
            Failure::Infeasible(reason) => {
                Ok(MotionOutcome::Infeasible { stage: self.stage, reason })
            }
            Failure::Plugin(error) => Err(error),
        }
    }
}
