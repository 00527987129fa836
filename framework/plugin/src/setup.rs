//! What a plugin is built from.

use crate::{PluginError, World};
use seeone_core::robot::RobotModel;
use std::path::Path;
use std::sync::Arc;

/// What a plugin is built from.
#[derive(Clone)]
pub struct Setup<'a> {
    /// The plugin's own table.
    pub config: &'a toml::Table,
    /// The folder against which the plugin resolves the paths of its table.
    pub root: &'a Path,
    /// The seed of the run.
    pub seed: u64,
    /// The robot of the cell, for the plugins that move or plan for it.
    pub robot: Option<&'a RobotModel>,
    /// The simulated world, when there is one.
    pub world: Option<Arc<dyn World>>,
}

impl Setup<'_> {
    /// The plugin's table read into its own type; give it
    /// `#[serde(deny_unknown_fields, default)]`.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] with what serde found.
    pub fn configuration<T: serde::de::DeserializeOwned>(&self) -> Result<T, PluginError> {
        self.config
            .clone()
            .try_into()
            .map_err(|e: toml::de::Error| PluginError::Configuration(e.message().to_owned()))
    }

    /// The robot that this plugin cannot do without.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] when none was given.
    pub fn robot(&self) -> Result<&RobotModel, PluginError> {
        self.robot
            .ok_or_else(|| PluginError::Configuration("this plugin needs a robot file".into()))
    }

    /// The shared world that this plugin cannot do without.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] when the cell is not simulated.
    pub fn world(&self) -> Result<Arc<dyn World>, PluginError> {
        self.world.clone().ok_or_else(|| {
            PluginError::Configuration("this plugin works in the simulated cell only".into())
        })
    }
}
