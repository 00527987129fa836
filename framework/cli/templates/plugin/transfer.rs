//! `my-plugin`, a plugin of kind `transfer`: looks for the demonstrated features higher and
//! lower than demonstrated.

use nalgebra::{Point3, Translation3};
use seeone_core::Pose;
use seeone_plugin::{Candidate, Field, PluginError, Setup, Transfer, TransferTask};
use serde::Deserialize;

seeone_plugin::export_plugins! {
    Transfer "my-plugin" => MyPlugin::from_setup,
}

/// Searches a grasp along the canonical z. Its fields are its table in a robot file,
/// `[config.transfer]`.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MyPlugin {
    /// How far up and down it looks, canonical units.
    reach: f64,
    /// Places looked at on the way up, and as many on the way down.
    steps: u32,
}

impl Default for MyPlugin {
    fn default() -> Self {
        Self { reach: 0.15, steps: 15 }
    }
}

impl MyPlugin {
    /// From its table.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for an unknown key or a number out of range.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        let plugin: Self = setup.configuration()?;
        if !(plugin.reach > 0.0 && plugin.reach <= 1.0) || plugin.steps == 0 {
            let told = format!("{plugin:?}: reach is above 0 and up to 1, steps at least 1");
            return Err(PluginError::Configuration(told));
        }
        Ok(plugin)
    }
}

/// The gripper's points at a canonical pose, of an object of `scale` metres a canonical unit.
fn placed(pose: &Pose, points: &[Point3<f64>], scale: f64) -> Vec<Point3<f64>> {
    points.iter().map(|point| pose * (point / scale)).collect()
}

impl Transfer for MyPlugin {
    fn transfer(&self, task: &TransferTask) -> Result<Vec<Candidate>, PluginError> {
        task.check()?;
        let points = task.gripper_points;
        let at = placed(task.demonstrated, points, task.demonstrated_scale);
        let wanted = task.demonstration.features(&at);
        let loss = |field: &dyn Field, pose: &Pose| {
            let found = field.features(&placed(pose, points, task.instance_scale));
            (found.width == wanted.width).then(|| found.mean_difference(&wanted))
        };
        let steps = i64::from(self.steps);
        let mut candidates = Vec::new();
        for step in -steps..=steps {
            let rise = self.reach * step as f64 / steps as f64;
            let pose = Translation3::new(0.0, 0.0, rise) * task.demonstrated;
            let Some(loss) = loss(task.instance, &pose) else {
                return Err(PluginError::Input("the two fields differ in width".into()));
            };
            candidates.push(Candidate {
                pose,
                loss,
                confidence: task.cloud.mean_confidence(),
                lay_on_surface: true,
                origin: format!("my-plugin: {rise:+.3} of the cube higher"),
            });
        }
        // Of equals the one that is moved least.
        candidates.sort_by(|a, b| {
            let moved =
                |c: &Candidate| (c.pose.translation.z - task.demonstrated.translation.z).abs();
            a.loss.total_cmp(&b.loss).then(moved(a).total_cmp(&moved(b)))
        });
        candidates.truncate(3);
        Ok(candidates)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_plugin::conformance;
    use seeone_plugin::conformance::transfer::Scene;

    #[test]
    fn conforms() {
        conformance::transfer(&MyPlugin::default()).expect("conforms");
    }

    #[test]
    fn finds_a_sheet_that_lies_higher() {
        let scene = Scene::with_rise(0.05);
        let found = MyPlugin::default().transfer(&scene.task()).expect("a valid task");
        let rise = found[0].pose.translation.z - scene.demonstrated.translation.z;
        assert!((rise - 0.05).abs() < 0.02, "{rise}");
    }
}
