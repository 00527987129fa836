//! NST as a perception plugin.

use crate::inference::{Effort, Nst, NstError};
use crate::network::FEATURES;
use seeone_core::Diagnostic;
use seeone_plugin::{CanonicalCloud, Observation, Perception, PluginError, Setup};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// The plugin's table.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct NstConfig {
    /// Folder of the weights and their card, relative to the plugin's root.
    pub weights: PathBuf,
}

impl Default for NstConfig {
    fn default() -> Self {
        Self { weights: "plugins/nst/weights".into() }
    }
}

/// NST behind the perception contract.
pub struct NstPerception {
    nst: Nst,
}

/// Builds the plugin from its table.
///
/// # Errors
/// [`PluginError::Configuration`] for a wrong table, [`PluginError::Resource`] when the
/// weights cannot be used.
pub fn build(setup: &Setup<'_>) -> Result<NstPerception, PluginError> {
    let config: NstConfig = setup.configuration()?;
    NstPerception::load(&setup.root.join(config.weights))
        .map_err(|e| PluginError::Resource(e.to_string()))
}

/// Builds the plugin `nst-one-pass` from its table: the same networks, the refiner asked
/// once. What the further passes and their average are worth is seen against it.
///
/// # Errors
/// As [`build`].
pub fn build_one_pass(setup: &Setup<'_>) -> Result<NstPerception, PluginError> {
    let NstPerception { nst } = build(setup)?;
    Ok(NstPerception { nst: nst.with_effort(Effort::OnePass) })
}

impl NstPerception {
    /// The perception whose weights and card lie in `folder`.
    ///
    /// # Errors
    /// When a file is missing or damaged.
    pub fn load(folder: &Path) -> Result<Self, Diagnostic> {
        Ok(Self { nst: Nst::load(folder)? })
    }

    /// What [`Perception::perceive`] answers; nothing is changed by asking.
    ///
    /// # Errors
    /// As there.
    pub fn canonical(&self, observation: &Observation) -> Result<CanonicalCloud, PluginError> {
        let points = observation.cloud.points();
        let perceived =
            self.nst.perceive(points, &observation.camera_position).map_err(|e| match e {
                NstError::Network(e) => PluginError::Internal(e.to_string()),
                other => PluginError::Input(other.to_string()),
            })?;
        Ok(CanonicalCloud {
            points: perceived.rows.iter().map(|row| points[*row]).collect(),
            nocs: perceived.nocs,
            confidence: perceived.confidence,
            features: perceived.features,
            feature_width: FEATURES,
        })
    }
}

impl Perception for NstPerception {
    fn perceive(&mut self, observation: &Observation) -> Result<CanonicalCloud, PluginError> {
        self.canonical(observation)
    }
}
