//! Kind `camera`: look once.

use crate::PluginError;
use nalgebra::Point3;
use seeone_core::{Cloud, DepthImage};

/// What one look gave.
#[derive(Clone, Debug)]
pub struct Observation {
    /// The depth image, where the source has one (a cloud read from a file has none).
    pub depth: Option<DepthImage>,
    /// The target's points in `world`, metres, already cut out of the scene.
    pub cloud: Cloud,
    /// Where the camera stood in `world`, metres.
    pub camera_position: Point3<f64>,
}

impl Observation {
    /// Says what no camera may answer.
    ///
    /// # Errors
    /// A sentence about an image of another size than its own, or a camera that is nowhere.
    pub fn check(&self) -> Result<(), String> {
        if let Some(image) = &self.depth {
            let (width, height) = (image.intrinsics.width, image.intrinsics.height);
            let pixels = image.depth_m.len();
            if width.checked_mul(height) != Some(pixels) {
                return Err(format!("a depth image of {width} x {height} has {pixels} pixels"));
            }
        }
        if !self.camera_position.coords.iter().all(|v| v.is_finite()) {
            return Err("the camera's position is not finite".into());
        }
        Ok(())
    }
}

/// A depth camera that knows its pose and cuts the target out of what it sees.
pub trait Camera: Send {
    /// Takes one image of the cell as it is now.
    ///
    /// # Errors
    /// When no image could be had. An empty cloud is not an error.
    fn observe(&mut self) -> Result<Observation, PluginError>;
}
