//! The steps of a run, and how one of them ended.

use bevy_ecs::component::Component;
use bevy_ecs::schedule::SystemSet;
use serde::{Deserialize, Serialize};

/// A step of a run, in order.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Step {
    /// Let go and go back to where the robot waits, after a run that failed.
    Withdraw,
    /// Ask whether what must be true before is true.
    Require,
    /// Look.
    Observe,
    /// Find the canonical coordinates of what was seen.
    Perceive,
    /// Make a field of features of them.
    Encode,
    /// Find the grasp.
    Transfer,
    /// Find a way to it and on.
    Plan,
    /// Move.
    Act,
    /// Look whether it came out as it was shown.
    Check,
    /// See how it ended.
    Judge,
    /// Write it down.
    Record,
}

impl Step {
    /// Every step, in order.
    pub const ALL: [Self; 11] = [
        Self::Withdraw,
        Self::Require,
        Self::Observe,
        Self::Perceive,
        Self::Encode,
        Self::Transfer,
        Self::Plan,
        Self::Act,
        Self::Check,
        Self::Judge,
        Self::Record,
    ];

    /// The name used in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Withdraw => "withdraw",
            Self::Require => "require",
            Self::Observe => "observe",
            Self::Perceive => "perceive",
            Self::Encode => "encode",
            Self::Transfer => "transfer",
            Self::Plan => "plan",
            Self::Act => "act",
            Self::Check => "check",
            Self::Judge => "judge",
            Self::Record => "record",
        }
    }
}

/// How a step of the run or a stage of the skill ended.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StageEvent {
    /// The step's name; for what the robot did, the skill's own name of the stage.
    pub name: String,
    /// Whether it did its work.
    pub ok: bool,
    /// How long it took: by the clock that was handed in for a step that thinks, by the
    /// robot's own time for a stage that moves.
    pub seconds: f64,
    /// Why not, when it did not; where contact ended its line, when that is how it did.
    pub reason: Option<String>,
}

/// Left on a run that cannot go on.
#[derive(Component, Clone, Debug, PartialEq, Eq)]
pub struct Failed {
    /// The step of the run, or the stage of the skill, that failed.
    pub stage: String,
    /// Why.
    pub reason: String,
}
