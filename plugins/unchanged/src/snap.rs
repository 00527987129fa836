//! The demonstrated pose laid onto the observed sheet.

use crate::unchanged::candidate;
use seeone_plugin::sheet::{Near, raised_to, sheet};
use seeone_plugin::{Candidate, PluginError, Setup, Transfer, TransferTask};
use serde::Deserialize;

/// Raises or lowers the demonstrated pose to the median height predicted for the points
/// above and below it: right where the grasped part is one thin sheet at that place, and
/// nothing else lies there.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Snap {
    /// Distance in x and y within which a point speaks for the sheet, canonical units.
    radius: f64,
    /// Number of points below which the pose stays as demonstrated.
    min_points: usize,
}

impl Default for Snap {
    fn default() -> Self {
        Self { radius: 0.1, min_points: 12 }
    }
}

impl Snap {
    /// From its table of the configuration: `radius` (canonical units) and `min_points`.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for an unknown key or a number out of range.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        let snap: Self = setup.configuration()?;
        if !snap.radius.is_finite() || snap.radius <= 0.0 {
            let told = format!("radius is {}, not a positive number", snap.radius);
            return Err(PluginError::Configuration(told));
        }
        if snap.min_points == 0 {
            return Err(PluginError::Configuration("min_points must be at least 1".into()));
        }
        Ok(snap)
    }
}

impl Transfer for Snap {
    fn transfer(&self, task: &TransferTask) -> Result<Vec<Candidate>, PluginError> {
        task.check()?;
        let unchanged = candidate(task);
        let place = task.demonstrated.translation.vector.into();
        let seen = sheet(task.cloud, &place, Near::Column(self.radius))
            .filter(|sheet| sheet.points >= self.min_points);
        Ok(match seen {
            None => vec![unchanged],
            Some(sheet) => vec![
                Candidate {
                    pose: raised_to(task.demonstrated, sheet.height),
                    loss: 0.0,
                    confidence: sheet.confidence,
                    lay_on_surface: true,
                    origin: format!("snapped to the median of {} points", sheet.points),
                },
                unchanged,
            ],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_plugin::CanonicalCloud;
    use seeone_plugin::conformance;
    use seeone_plugin::conformance::transfer::Scene;
    use std::path::Path;

    #[test]
    fn conforms() {
        conformance::transfer(&Snap::default()).expect("conforms");
    }

    #[test]
    fn lands_on_the_sheet_and_moves_nowhere_else() {
        let scene = Scene::with_rise(0.07);
        let found = Snap::default().transfer(&scene.task()).expect("a valid task");
        let moved = found[0].pose.translation.vector - scene.demonstrated.translation.vector;
        assert!((moved - nalgebra::Vector3::new(0.0, 0.0, 0.07)).norm() < 1e-12);
        assert_eq!(found[0].pose.rotation, scene.demonstrated.rotation);
        assert_eq!(found[1].pose, scene.demonstrated);
    }

    #[test]
    fn stays_where_too_little_is_seen() {
        let mut scene = Scene::with_rise(0.07);
        let few = |points: &[_]| points[..5].to_vec();
        scene.cloud = CanonicalCloud {
            points: few(&scene.cloud.points),
            nocs: few(&scene.cloud.nocs),
            confidence: scene.cloud.confidence[..5].to_vec(),
            ..CanonicalCloud::default()
        };
        let found = Snap::default().transfer(&scene.task()).expect("a valid task");
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].pose, scene.demonstrated);
    }

    #[test]
    fn wrong_tables_are_refused() {
        for table in ["radius = 0.0", "radius = nan", "min_points = 0", "raduis = 0.1"] {
            let config = table.parse().expect("TOML");
            let setup =
                Setup { config: &config, root: Path::new("."), seed: 0, world: None, robot: None };
            let told = Snap::from_setup(&setup);
            assert!(matches!(told, Err(PluginError::Configuration(_))), "{table}: {told:?}");
        }
    }
}
