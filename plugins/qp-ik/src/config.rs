//! The solvers' table in a configuration.

use seeone_plugin::PluginError;
use serde::Deserialize;

/// Options of both solvers.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct IkConfig {
    /// Whether to start from the closed form where the arm has one.
    pub closed_form: bool,
    /// Seeded random starts after all others.
    pub restarts: usize,
    /// How many different solutions that touch nothing are gathered from random starts before the
    /// best of them is chosen; with 1 the first one is taken.
    pub solutions: usize,
    /// Most steps from one start.
    pub max_iterations: usize,
    /// Largest joint step, radians.
    pub step_rad: f64,
    /// Weight of the step's own length against the pose error, square metres a square
    /// radian: keeps steps short near singularities.
    pub damping: f64,
    /// Weight of the distance from the start posture, square metres a square radian:
    /// chooses among the many answers of a redundant arm.
    pub posture: f64,
}

impl Default for IkConfig {
    fn default() -> Self {
        Self {
            closed_form: true,
            restarts: 100,
            solutions: 4,
            max_iterations: 60,
            step_rad: 0.6,
            damping: 1e-6,
            posture: 1e-8,
        }
    }
}

impl IkConfig {
    /// # Errors
    /// [`PluginError::Configuration`] for a number without meaning.
    pub(crate) fn checked(self) -> Result<Self, PluginError> {
        let told = |cause: &str| Err(PluginError::Configuration(cause.into()));
        if self.max_iterations == 0 {
            return told("max_iterations must be at least 1");
        }
        if self.solutions == 0 {
            return told("solutions must be at least 1");
        }
        if !(self.step_rad.is_finite() && self.step_rad > 0.0) {
            return told("step_rad must be positive");
        }
        if !(self.damping.is_finite() && self.damping > 0.0) {
            return told("damping must be positive");
        }
        if !(self.posture.is_finite() && self.posture >= 0.0) {
            return told("posture must not be negative");
        }
        Ok(self)
    }
}
