//! `camera-sim`: one noisy depth image of the simulated cell a look.

use crate::{Configuration, NoiseTable};
use nalgebra::Point3;
use rand::Rng;
use seeone_core::random::{Generator, generator};
use seeone_core::{Intrinsics, Pose, TriangleMesh};
use seeone_plugin::{Camera, Observation, PluginError, Setup, World};
use seeone_sim::depth_camera::{Noise, capture};
use seeone_sim::segmentation::DropZone;
use std::sync::Arc;

/// A depth camera in the simulated cell.
pub struct SimulatedCamera {
    world: Arc<dyn World>,
    pose: Pose,
    intrinsics: Intrinsics,
    zone: DropZone,
    apart_m: Option<f64>,
    by_colour: bool,
    noise: Noise,
    random: Generator,
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
        if let Some(apart_m) = crop.apart_m
            && !(apart_m.is_finite() && apart_m > 0.0)
        {
            let cause = format!("apart_m = {apart_m} is no distance");
            return Err(PluginError::Configuration(cause));
        }
        let noise = noise(configuration.noise)?;
        let zone = DropZone {
            centre_m: crop.centre_xy_m,
            half_extents_m: crop.half_extents_m,
            floor_m: crop.floor_m,
            height_m: crop.height_m,
        };
        Ok(Self {
            world: setup.world()?,
            pose,
            intrinsics: configuration.intrinsics,
            zone,
            apart_m: crop.apart_m,
            by_colour: configuration.by_colour,
            noise,
            random: generator(setup.seed, "camera"),
        })
    }

    fn look(&self, random: &mut impl Rng) -> Result<Observation, PluginError> {
        let surfaces = self.world.surfaces()?;
        let meshes: Vec<&TriangleMesh> = surfaces.iter().map(|surface| &surface.mesh).collect();
        let shot = capture(&meshes, &self.pose, &self.intrinsics, &self.noise, random);
        let cloud = if self.by_colour {
            let coloured = |pixel| shot.shows(pixel, |mesh| surfaces[mesh].is_object);
            self.zone.coloured(&shot.image, &self.pose, coloured)
        } else {
            self.zone.cloud(&shot.image, &self.pose, self.apart_m)
        };
        let camera_position = Point3::from(self.pose.translation.vector);
        Ok(Observation { depth: Some(shot.image), cloud, camera_position })
    }
}

/// The usual noise, changed as the table says.
fn noise(NoiseTable { times, outliers }: NoiseTable) -> Result<Noise, PluginError> {
    if !(times.is_finite() && times >= 0.0 && (0.0..=1.0).contains(&outliers)) {
        let cause = format!("noise of {times} times the usual, {outliers} of it outliers, is none");
        return Err(PluginError::Configuration(cause));
    }
    let usual = Noise::default();
    Ok(Noise { disparity_px: usual.disparity_px * times, outliers, ..usual })
}

impl Camera for SimulatedCamera {
    fn observe(&mut self) -> Result<Observation, PluginError> {
        let mut random = self.random.clone();
        let observation = self.look(&mut random);
        self.random = random;
        observation
    }
}
