//! `my-plugin`, a plugin of kind `perception`: canonical coordinates by the box of what is seen,
//! turned to the camera.

use nalgebra::{Point3, UnitQuaternion, Vector3};
use seeone_plugin::{CanonicalCloud, Observation, Perception, PluginError, Setup};
use serde::Deserialize;

seeone_plugin::export_plugins! {
    Perception "my-plugin" => MyPlugin::from_setup,
}

/// Perceives by the box of the cloud. Its fields are its table in a robot file,
/// `[config.perception]`.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MyPlugin {
    /// How sure it says it is, in `[0, 1]`.
    confidence: f64,
}

impl Default for MyPlugin {
    fn default() -> Self {
        Self { confidence: 0.5 }
    }
}

/// Fewer points than this have no box to speak of.
const FEWEST_POINTS: usize = 16;

impl MyPlugin {
    /// From its table.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for an unknown key or a number out of range.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        let plugin: Self = setup.configuration()?;
        if !(0.0..=1.0).contains(&plugin.confidence) {
            let told = format!("confidence is {}, not from 0 to 1", plugin.confidence);
            return Err(PluginError::Configuration(told));
        }
        Ok(plugin)
    }
}

impl Perception for MyPlugin {
    fn perceive(&mut self, observation: &Observation) -> Result<CanonicalCloud, PluginError> {
        observation.check().map_err(PluginError::Input)?;
        let points = observation.cloud.points();
        if points.len() < FEWEST_POINTS {
            let told = format!("{} points are fewer than {FEWEST_POINTS}", points.len());
            return Err(PluginError::Input(told));
        }
        // Seen from the camera: its azimuth about the cloud becomes +y.
        let away = observation.camera_position - observation.cloud.centroid();
        let azimuth = away.x.atan2(away.y);
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), azimuth);
        let turned: Vec<Point3<f64>> = points.iter().map(|p| turn * p).collect();
        let (mut low, mut high) = (turned[0], turned[0]);
        for point in &turned {
            low = low.inf(point);
            high = high.sup(point);
        }
        let edge = (high - low).max();
        if edge <= 0.0 {
            return Err(PluginError::Input("all points are one".into()));
        }
        let middle = nalgebra::center(&low, &high);
        let half = Vector3::repeat(0.5);
        let nocs: Vec<_> =
            turned.iter().map(|p| Point3::from((p - middle) / edge + half)).collect();
        let features = nocs.iter().flat_map(|p| [p.x as f32, p.y as f32, p.z as f32]).collect();
        Ok(CanonicalCloud {
            points: points.to_vec(),
            confidence: vec![[self.confidence; 3]; nocs.len()],
            nocs,
            features,
            feature_width: 3,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_plugin::conformance;

    #[test]
    fn conforms() {
        conformance::perception(&mut MyPlugin::default()).expect("conforms");
    }
}
