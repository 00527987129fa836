//! Where does each observed point lie in the canonical state: on the object that was
//! shown, and on this one?

use super::assignment::Assignment;
use super::bench::Bench;
use super::observe::Seen;
use super::schedule::leave;
use super::step::{Failed, Step};
use crate::plugins::Plugins;
use bevy_ecs::prelude::*;
use seeone_plugin::{CanonicalCloud, Observation};

/// The canonical clouds of a run. The demonstration goes through the same plugins as the
/// instance: whatever those get wrong the same way on both then cancels.
#[derive(Component, Clone, Debug)]
pub struct Perceived {
    /// Of the object that was shown.
    pub demonstration: CanonicalCloud,
    /// Of this object.
    pub instance: CanonicalCloud,
}

pub(super) fn perceive(
    mut commands: Commands,
    mut bench: NonSendMut<Bench>,
    runs: Query<(Entity, &Assignment, &Seen), Without<Failed>>,
) {
    for (run, assignment, seen) in &runs {
        let shown = Observation {
            depth: None,
            cloud: assignment.demonstration.clone(),
            camera_position: assignment.skill.demonstration.camera_position,
        };
        let perceived = bench.step(Step::Perceive, |plugins| {
            let demonstration =
                perceived(plugins, &shown).map_err(|e| format!("the demonstration: {e}"))?;
            let instance = perceived(plugins, &seen.0)?;
            Ok(Perceived { demonstration, instance })
        });
        leave(&mut commands, run, perceived);
    }
}

/// What the perception says of `observation`, if it is sound.
pub(super) fn perceived(
    plugins: &mut Plugins,
    observation: &Observation,
) -> Result<CanonicalCloud, String> {
    let cloud = plugins.perception.perceive(observation).map_err(|e| e.to_string())?;
    sound(&cloud).map(|()| cloud)
}

/// What no plugin may hand on: vectors of unequal length, numbers that are not finite.
fn sound(cloud: &CanonicalCloud) -> Result<(), String> {
    let n = cloud.len();
    let equal = cloud.nocs.len() == n
        && cloud.confidence.len() == n
        && cloud.features.len() == n * cloud.feature_width;
    let finite = cloud.points.iter().chain(&cloud.nocs).all(|p| p.iter().all(|v| v.is_finite()))
        && cloud.confidence.iter().flatten().all(|v| (0.0..=1.0).contains(v))
        && cloud.features.iter().all(|v| v.is_finite());
    match (equal, finite) {
        (true, true) => Ok(()),
        (false, _) => Err("the perception's vectors differ in length".into()),
        (_, false) => Err("the perception gave numbers that are not finite or no share".into()),
    }
}
