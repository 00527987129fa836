//! The plugin: search, snap, rank.

use crate::config::Config;
use crate::matching::Matching;
use crate::search::{Found, search};
use nalgebra::{Point3, Vector3};
use seeone_plugin::sheet::{Near, Sheet, raised_to, sheet};
use seeone_plugin::{Candidate, PluginError, Setup, Transfer, TransferTask};

/// Transfer of the demonstrated pose by a held search over features.
///
/// Its candidates, best first: the minimum laid onto the observed sheet (where that was
/// seen), the minimum as found, further minima of the grid, and the demonstrated pose.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FeatureMatch {
    config: Config,
}

impl FeatureMatch {
    /// From its table of the configuration: `x`, `y`, `z` (each `reach`, `steps`, `spread`),
    /// `prior`, `temperature`, `snap_radius`, `snap_points` and `alternatives`.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for an unknown key or a number out of range.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        Ok(Self { config: setup.configuration::<Config>()?.checked()? })
    }

    /// The observed sheet near a canonical offset from the demonstrated pose.
    fn seen(&self, task: &TransferTask, offset: &Vector3<f64>) -> Option<Sheet> {
        let place = Point3::from(task.demonstrated.translation.vector + offset);
        sheet(task.cloud, &place, Near::Ball(self.config.snap_radius))
            .filter(|sheet| sheet.points >= self.config.snap_points)
    }
}

impl Transfer for FeatureMatch {
    fn transfer(&self, task: &TransferTask) -> Result<Vec<Candidate>, PluginError> {
        task.check()?;
        let matching = Matching::new(task, &self.config)?;
        let found = search(&matching, &self.config)?;
        let mut candidates = Vec::new();
        if let Some(sheet) = self.seen(task, &found.best.0) {
            let pose = raised_to(&matching.pose(&found.best.0), sheet.height);
            let offset = pose.translation.vector - task.demonstrated.translation.vector;
            candidates.push(Candidate {
                pose,
                loss: matching.loss(&offset)?,
                // What was seen there vouches for it, and the search for the place.
                confidence: sheet.confidence * (0.5 + 0.5 * found.certainty),
                lay_on_surface: true,
                origin: format!("feature match, snapped to {} points", sheet.points),
            });
        }
        candidates.extend(self.unsnapped(task, &matching, &found));
        Ok(candidates)
    }
}

impl FeatureMatch {
    /// What rests on the features alone. A grasp whose surroundings are hidden deserves
    /// another look, so that these are trusted half as much as a seen one at most.
    fn unsnapped(&self, task: &TransferTask, matching: &Matching, found: &Found) -> Vec<Candidate> {
        let trust = 0.5 * found.certainty * task.cloud.mean_confidence();
        let likeness = |loss: f64| ((found.best.1 - loss) / self.config.temperature).exp().min(1.0);
        let candidate = |offset: &Vector3<f64>, loss: f64, origin: &str| Candidate {
            pose: matching.pose(offset),
            loss,
            confidence: trust * likeness(loss),
            lay_on_surface: false,
            origin: origin.to_owned(),
        };
        let others = found.others.iter().map(|(o, loss)| candidate(o, *loss, "another minimum"));
        std::iter::once(candidate(&found.best.0, found.best.1, "feature match"))
            .chain(others)
            .chain([candidate(&Vector3::zeros(), found.unmoved, "demonstrated pose unchanged")])
            .collect()
    }
}
