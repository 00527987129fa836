//! Least squares, then reweighting.

use crate::closed_form::fit;
use crate::reweighting::{Reweighting, on_a_line};
use seeone_plugin::{Alignment, AlignmentOutcome, Correspondences, PluginError, Setup};

/// Robust Procrustes alignment: the weighted least-squares similarity, reweighted until
/// the pairs that disagree no longer count.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Procrustes {
    reweighting: Reweighting,
}

impl Procrustes {
    /// From its table of the configuration ([`Reweighting`]).
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for an unknown key or a number out of range.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        Ok(Self { reweighting: setup.configuration::<Reweighting>()?.checked()? })
    }
}

impl Alignment for Procrustes {
    fn align(&self, pairs: &Correspondences) -> Result<AlignmentOutcome, PluginError> {
        pairs.check()?;
        let first = fit(pairs, pairs.weights).ok_or_else(on_a_line)?;
        self.reweighting.refine(pairs, first, f64::INFINITY)
    }
}
