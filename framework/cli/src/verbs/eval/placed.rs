//! How the objects of an evaluation were placed, by what its skill counts as success.

use crate::rate::Rate;
use seeone_plugin::Measure;
use seeone_runtime::run::Outcome;
use serde::Serialize;

/// A cap is worn properly when, besides its error, its tilt and yaw are below these.
const PROPER_TILT_DEG: f64 = 10.0;
const PROPER_YAW_DEG: f64 = 15.0;
/// What counts as placed at all where wearing is judged, share of d.
const WIDEST_D: f64 = 0.2;

/// What lies farther from the worn state than this is not on the head, share of d.
const BESIDE_D: f64 = 0.5;

/// The rates of a skill with one measure.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub enum Placed {
    /// Of wearing.
    Worn {
        /// Below 0.05 d.
        worn_within_005_d: Rate,
        /// Below 0.1 d.
        worn_within_01_d: Rate,
        /// Below 0.2 d.
        worn_within_02_d: Rate,
        /// Below 0.1 d, and neither tilted nor turned.
        worn_properly: Rate,
        /// Mean vertex error over those below 0.2 d.
        mean_error_m_of_worn_within_02_d: Option<f64>,
    },
    /// Of hanging.
    Hung {
        /// On the hook by themselves.
        hung: Rate,
    },
    /// Of holding.
    Held {
        /// In the hand, where it was to bring them.
        held: Rate,
    },
}

impl Placed {
    /// What `attempts` came to.
    pub fn of(measure: &Measure, attempts: &[&Outcome]) -> Self {
        let rate =
            |ok: &dyn Fn(&Outcome) -> bool| Rate::of(attempts.iter().map(|outcome| ok(outcome)));
        let succeeded = || rate(&|outcome| outcome.success == Some(true));
        match measure {
            Measure::Worn { .. } => Self::Worn {
                worn_within_005_d: rate(&|outcome| worn(outcome, 0.05)),
                worn_within_01_d: rate(&|outcome| worn(outcome, 0.1)),
                worn_within_02_d: rate(&|outcome| worn(outcome, WIDEST_D)),
                worn_properly: rate(&properly),
                mean_error_m_of_worn_within_02_d: mean_error_m(attempts),
            },
            Measure::Hung => Self::Hung { hung: succeeded() },
            Measure::Held { .. } => Self::Held { held: succeeded() },
        }
    }

    /// How one attempt failed that does not count as placed at all: the stage, or how its object
    /// came to lie.
    pub fn failure(measure: &Measure, outcome: &Outcome) -> Option<String> {
        let placed = match measure {
            Measure::Worn { .. } => worn(outcome, WIDEST_D),
            Measure::Hung | Measure::Held { .. } => outcome.success == Some(true),
        };
        let lies = match (measure, outcome.error_d) {
            (Measure::Worn { .. }, Some(error_d)) if error_d < BESIDE_D => "askew",
            (Measure::Worn { .. }, _) => "beside",
            (Measure::Hung | Measure::Held { .. }, _) => "placed",
        };
        let stage = outcome.failed_at.as_deref();
        (!placed).then(|| stage.unwrap_or(lies).to_owned())
    }

    /// What is counted, and its rate.
    pub fn rates(&self) -> Vec<(&'static str, &Rate)> {
        match self {
            Self::Worn {
                worn_within_005_d,
                worn_within_01_d,
                worn_within_02_d,
                worn_properly,
                ..
            } => vec![
                ("worn within 0.2 d", worn_within_02_d),
                ("worn within 0.1 d", worn_within_01_d),
                ("worn within 0.05 d", worn_within_005_d),
                ("worn properly", worn_properly),
            ],
            Self::Hung { hung } => vec![("hung", hung)],
            Self::Held { held } => vec![("held at its place", held)],
        }
    }

    /// Mean vertex error, metres, where there is one.
    pub fn mean_error_m(&self) -> Option<f64> {
        match self {
            Self::Worn { mean_error_m_of_worn_within_02_d, .. } => {
                *mean_error_m_of_worn_within_02_d
            }
            Self::Hung { .. } | Self::Held { .. } => None,
        }
    }
}

fn worn(outcome: &Outcome, tolerance_d: f64) -> bool {
    let near = outcome.error_d.is_some_and(|e| e < tolerance_d);
    outcome.grasped == Some(true) && outcome.failed_at.is_none() && near
}

fn properly(outcome: &Outcome) -> bool {
    worn(outcome, 0.1)
        && outcome.tilt_deg.is_some_and(|t| t < PROPER_TILT_DEG)
        && outcome.yaw_deg.is_some_and(|y| y.abs() < PROPER_YAW_DEG)
}

fn mean_error_m(attempts: &[&Outcome]) -> Option<f64> {
    let worn = attempts.iter().filter(|outcome| worn(outcome, WIDEST_D));
    let errors: Vec<f64> = worn.filter_map(|outcome| outcome.error_m).collect();
    (!errors.is_empty()).then(|| errors.iter().sum::<f64>() / errors.len() as f64)
}
