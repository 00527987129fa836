//! Look once.

use super::assignment::Assignment;
use super::bench::Bench;
use super::schedule::leave;
use super::step::{Failed, Step};
use bevy_ecs::prelude::*;
use seeone_plugin::Observation;

/// What is told when the cloud is empty.
pub(crate) const NOTHING: &str = "nothing of the object is in sight";

/// What the camera saw.
#[derive(Component, Clone, Debug)]
pub struct Seen(pub Observation);

pub(super) fn observe(
    mut commands: Commands,
    mut bench: NonSendMut<Bench>,
    runs: Query<Entity, (With<Assignment>, Without<Failed>)>,
) {
    for run in &runs {
        let seen = bench.step(Step::Observe, |plugins| {
            let observation = plugins.camera.observe().map_err(|e| e.to_string())?;
            if observation.cloud.is_empty() {
                return Err(NOTHING.into());
            }
            Ok(Seen(observation))
        });
        leave(&mut commands, run, seen);
    }
}
