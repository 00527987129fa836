//! The demonstrated pose as it is.

use seeone_plugin::{Candidate, PluginError, Setup, Transfer, TransferTask};
use serde::Deserialize;

/// Takes the demonstrated canonical pose for the instance's: right as far as the canonical
/// state puts the same part of every object at the same place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Unchanged;

/// The table of the configuration, which has no keys.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Config {}

impl Unchanged {
    /// From its table of the configuration, which is empty.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for any key.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        let Config {} = setup.configuration()?;
        Ok(Self)
    }
}

/// The demonstrated pose as a candidate. Nothing is compared, so its loss is zero, and its
/// confidence is how sure the perception is of the cloud.
pub(crate) fn candidate(task: &TransferTask) -> Candidate {
    Candidate {
        pose: *task.demonstrated,
        loss: 0.0,
        confidence: task.cloud.mean_confidence(),
        lay_on_surface: false,
        origin: "demonstrated pose unchanged".into(),
    }
}

impl Transfer for Unchanged {
    fn transfer(&self, task: &TransferTask) -> Result<Vec<Candidate>, PluginError> {
        task.check()?;
        Ok(vec![candidate(task)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_plugin::conformance;
    use seeone_plugin::conformance::transfer::Scene;

    #[test]
    fn conforms() {
        conformance::transfer(&Unchanged).expect("conforms");
    }

    #[test]
    fn keeps_the_pose_to_the_bit() {
        let scene = Scene::with_rise(0.05);
        let found = Unchanged.transfer(&scene.task()).expect("a valid task");
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].pose, scene.demonstrated);
        assert!((found[0].confidence - 0.9).abs() < 1e-12);
    }
}
