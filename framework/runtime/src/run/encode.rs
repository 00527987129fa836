//! A field of features on the canonical cube for both objects.

use super::assignment::Assignment;
use super::bench::Bench;
use super::perceive::Perceived;
use super::schedule::leave;
use super::step::{Failed, Step};
use bevy_ecs::prelude::*;
use seeone_plugin::Field;

/// The fields of a run.
#[derive(Component)]
pub struct Encoded {
    /// Of the object that was shown.
    pub demonstration: Box<dyn Field>,
    /// Of this object.
    pub instance: Box<dyn Field>,
}

pub(super) fn encode(
    mut commands: Commands,
    mut bench: NonSendMut<Bench>,
    runs: Query<(Entity, &Assignment, &Perceived), Without<Failed>>,
) {
    for (run, _, perceived) in &runs {
        let encoded = bench.step(Step::Encode, |plugins| {
            let mut encode = |cloud| plugins.encoding.encode(cloud).map_err(|e| e.to_string());
            Ok(Encoded {
                demonstration: encode(&perceived.demonstration)?,
                instance: encode(&perceived.instance)?,
            })
        });
        leave(&mut commands, run, encoded);
    }
}
