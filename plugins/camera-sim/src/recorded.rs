//! `camera-file`: every look gives the same recorded cloud.

use crate::Configuration;
use nalgebra::Point3;
use seeone_core::formats::ply;
use seeone_plugin::{Camera, Observation, PluginError, Setup};

/// A camera that shows what was recorded.
pub struct RecordedCamera {
    observation: Observation,
}

impl RecordedCamera {
    /// Reads the cloud that the scene's camera table names: a PLY file, metres, `world`.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for a table without `cloud`,
    /// [`PluginError::Resource`] for a file that is missing or no cloud.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        let configuration: Configuration = setup.configuration()?;
        let Some(cloud) = &configuration.cloud else {
            return Err(PluginError::Configuration(
                "camera-file needs `cloud = \"FILE.ply\"` in the scene's [camera]".into(),
            ));
        };
        let pose = configuration.pose.resolve().map_err(PluginError::Configuration)?;
        let cloud = ply::read_cloud(&setup.root.join(cloud))
            .map_err(|fault| PluginError::Resource(fault.to_string()))?;
        let camera_position = Point3::from(pose.translation.vector);
        Ok(Self { observation: Observation { depth: None, cloud, camera_position } })
    }
}

impl Camera for RecordedCamera {
    fn observe(&mut self) -> Result<Observation, PluginError> {
        Ok(self.observation.clone())
    }
}
