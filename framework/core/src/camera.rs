//! The pinhole depth camera.
//!
//! Camera frame: x right, y down, z along the optical axis.

use crate::{Cloud, Pose};
use nalgebra::Point3;
use serde::{Deserialize, Serialize};

/// Pinhole intrinsics in pixels, without distortion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Intrinsics {
    /// Image width in pixels.
    pub width: usize,
    /// Image height in pixels.
    pub height: usize,
    /// Focal length along x in pixels.
    pub fx: f64,
    /// Focal length along y in pixels.
    pub fy: f64,
    /// Principal point, x, in pixels.
    pub cx: f64,
    /// Principal point, y, in pixels.
    pub cy: f64,
}

impl Intrinsics {
    /// The camera-frame point seen at pixel centre `(column, row)` at depth `z_m`.
    pub fn deproject(&self, column: usize, row: usize, z_m: f64) -> Point3<f64> {
        Point3::new(
            (column as f64 - self.cx) / self.fx * z_m,
            (row as f64 - self.cy) / self.fy * z_m,
            z_m,
        )
    }

    /// Pixel coordinates and depth of a camera-frame point in front of the camera.
    pub fn project(&self, point: &Point3<f64>) -> Option<(f64, f64, f64)> {
        (point.z > 0.0).then(|| {
            (self.fx * point.x / point.z + self.cx, self.fy * point.y / point.z + self.cy, point.z)
        })
    }
}

/// A depth image; `0` where the sensor saw nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthImage {
    /// The camera that took it.
    pub intrinsics: Intrinsics,
    /// Depth along the optical axis in metres, row by row.
    pub depth_m: Vec<f32>,
}

impl DepthImage {
    /// The valid pixels for which `keep(world point)` holds, as a cloud in `world`.
    /// `camera` is the camera's pose in `world`.
    pub fn cloud(&self, camera: &Pose, keep: impl Fn(&Point3<f64>) -> bool) -> Cloud {
        let width = self.intrinsics.width;
        let points = self
            .depth_m
            .iter()
            .enumerate()
            .filter(|(_, z)| z.is_finite() && **z > 0.0)
            .map(|(i, z)| camera * self.intrinsics.deproject(i % width, i / width, f64::from(*z)))
            .filter(|p| p.coords.iter().all(|v| v.is_finite()) && keep(p))
            .collect();
        Cloud::new(points).unwrap_or_default()
    }
}
