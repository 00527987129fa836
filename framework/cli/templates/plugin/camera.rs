//! `my-plugin`, a plugin of kind `camera`: sees points on every surface of the simulated world
//! that lies in its box or has the target's colour, hidden or not. For a real camera, ask its
//! driver instead of the world.

use nalgebra::Point3;
use seeone_core::Cloud;
use seeone_core::pose::PoseFields;
use seeone_core::random::{Generator, generator, uniform};
use seeone_plugin::{Camera, Observation, PluginError, Setup, World};
use serde::Deserialize;
use std::sync::Arc;

seeone_plugin::export_plugins! {
    Camera "my-plugin" => MyPlugin::from_setup,
}

/// The table that a scene gives its camera, and what a robot file's `[config.camera]` adds.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Configuration {
    /// The camera's frame in `world`.
    pose: PoseFields,
    /// Where the target is looked for.
    crop: Crop,
    /// Whether the target is told by its colour instead, wherever it is.
    #[serde(default)]
    by_colour: bool,
    /// The lens, which this camera has no use for.
    #[serde(default, rename = "intrinsics")]
    _intrinsics: Option<seeone_core::Intrinsics>,
    /// Points of one look.
    #[serde(default = "points")]
    points: usize,
}

fn points() -> usize {
    2048
}

/// The box in `world` that holds the target, metres.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Crop {
    centre_xy_m: [f64; 2],
    half_extents_m: [f64; 2],
    floor_m: f64,
    height_m: f64,
}

/// What lies lower is taken for the mat, metres.
const MAT_M: f64 = 0.004;

impl Crop {
    fn holds(&self, point: &Point3<f64>) -> bool {
        let beside =
            |axis: usize| (point[axis] - self.centre_xy_m[axis]).abs() < self.half_extents_m[axis];
        beside(0) && beside(1) && (MAT_M..self.height_m).contains(&(point.z - self.floor_m))
    }
}

/// A camera in the simulated world.
pub struct MyPlugin {
    world: Arc<dyn World>,
    position: Point3<f64>,
    crop: Crop,
    by_colour: bool,
    points: usize,
    random: Generator,
}

impl MyPlugin {
    /// From its table and its world.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for a table that is no camera's, or a cell that is not
    /// simulated.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        let Configuration { pose, crop, by_colour, points, .. } = setup.configuration()?;
        let pose = pose.resolve().map_err(PluginError::Configuration)?;
        let position = Point3::from(pose.translation.vector);
        let random = generator(setup.seed, "my-plugin");
        Ok(Self { world: setup.world()?, position, crop, by_colour, points, random })
    }
}

impl Camera for MyPlugin {
    fn observe(&mut self) -> Result<Observation, PluginError> {
        let mut corners = Vec::new();
        for surface in self.world.surfaces()? {
            let mesh = surface.mesh;
            let triangles = (0..mesh.triangles().len()).map(|i| mesh.corners(i));
            corners.extend(triangles.filter(|c| {
                let middle = Point3::from((c[0].coords + c[1].coords + c[2].coords) / 3.0);
                if self.by_colour { surface.is_object } else { self.crop.holds(&middle) }
            }));
        }
        let area = |c: &[Point3<f64>; 3]| (c[1] - c[0]).cross(&(c[2] - c[0])).norm();
        let mut below = 0.0;
        let areas: Vec<f64> = corners
            .iter()
            .map(|c| {
                below += area(c);
                below
            })
            .collect();
        let random = &mut self.random;
        let mut seen = Vec::new();
        for _ in 0..if corners.is_empty() { 0 } else { self.points } {
            let at = uniform(random, 0.0, below);
            let chosen = areas.partition_point(|sum| *sum < at).min(corners.len() - 1);
            let [a, b, c] = corners[chosen];
            let u = uniform(random, 0.0, 1.0).sqrt();
            let v = uniform(random, 0.0, 1.0);
            seen.push(a + (b - a) * (u * (1.0 - v)) + (c - a) * (u * v));
        }
        let cloud = Cloud::new(seen)
            .map_err(|i| PluginError::Internal(format!("point {i} is not finite")))?;
        Ok(Observation { depth: None, cloud, camera_position: self.position })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_plugin::conformance::{self, StillWorld};
    use std::path::Path;

    #[test]
    fn conforms() {
        let config = "
            pose = { xyz_m = [0.5, 0.0, 0.8], quat_xyzw = [1, 0, 0, 0] }
            [crop]
            centre_xy_m = [0.5, 0.0]
            half_extents_m = [0.25, 0.25]
            floor_m = 0.0
            height_m = 0.4"
            .parse()
            .expect("TOML");
        let build = || -> Result<Box<dyn Camera>, PluginError> {
            let world: Arc<dyn World> = Arc::new(StillWorld::default());
            let root = Path::new(".");
            let setup = Setup { config: &config, root, seed: 0, robot: None, world: Some(world) };
            Ok(Box::new(MyPlugin::from_setup(&setup)?))
        };
        conformance::camera(&build).expect("conforms");
        let seen = build().expect("a camera").observe().expect("a look");
        assert_eq!(seen.cloud.len(), 2048);
    }
}
