//! `camera-sim`: one noisy depth image of the simulated cell a look.

use crate::Configuration;
use nalgebra::Point3;
use rand::Rng;
use seeone_core::random::{Generator, generator};
use seeone_core::{Intrinsics, Pose};
use seeone_plugin::{Camera, Observation, PluginError, Setup};
use seeone_sim::cell::Cell;
use seeone_sim::segmentation::DropZone;
use std::sync::{Arc, Mutex};

/// A depth camera in the simulated cell.
pub struct SimulatedCamera {
    cell: Arc<Mutex<Cell>>,
    pose: Pose,
    intrinsics: Intrinsics,
    zone: DropZone,
    noise: Generator,
}

impl SimulatedCamera {
    /// Builds it from the scene's camera table.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for a table that is no camera's, or a cell that is
    /// not simulated.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        let configuration: Configuration = setup.configuration()?;
        let pose = configuration.pose.resolve().map_err(PluginError::Configuration)?;
        let crop = configuration.crop;
        let zone = DropZone {
            centre_m: crop.centre_xy_m,
            half_extents_m: crop.half_extents_m,
            floor_m: crop.floor_m,
            height_m: crop.height_m,
        };
        Ok(Self {
            cell: setup.world::<Mutex<Cell>>()?,
            pose,
            intrinsics: configuration.intrinsics,
            zone,
            noise: generator(setup.seed, "camera"),
        })
    }

    fn look(&mut self, noise: &mut impl Rng) -> Result<Observation, PluginError> {
        let cell = self
            .cell
            .lock()
            .map_err(|_| PluginError::Internal("the simulated cell broke down".into()))?;
        let depth = cell.depth_image(&self.pose, &self.intrinsics, noise);
        let cloud = self.zone.cloud(&depth, &self.pose);
        let camera_position = Point3::from(self.pose.translation.vector);
        Ok(Observation { depth: Some(depth), cloud, camera_position })
    }
}

impl Camera for SimulatedCamera {
    fn observe(&mut self) -> Result<Observation, PluginError> {
        let mut noise = self.noise.clone();
        let observation = self.look(&mut noise);
        self.noise = noise;
        observation
    }
}
