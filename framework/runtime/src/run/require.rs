//! What must be true before a run begins, asked of the robot's own camera and gripper.

use super::assignment::Assignment;
use super::bench::Bench;
use super::cancel::Cancel;
use super::observe::NOTHING;
use super::step::{Failed, Step};
use crate::plugins::Plugins;
use bevy_ecs::prelude::*;
use seeone_plugin::{Action, JointTrajectory};

/// How long the hand is felt, seconds.
const FEEL_S: f64 = 0.1;

/// What can be asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precondition {
    /// The camera sees something of the object.
    ObjectVisible,
    /// The gripper feels nothing between its pads.
    HandEmpty,
}

impl Precondition {
    /// Every one.
    pub const ALL: [Self; 2] = [Self::ObjectVisible, Self::HandEmpty];

    /// The name used in files and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::ObjectVisible => "object-visible",
            Self::HandEmpty => "hand-empty",
        }
    }

    /// The precondition of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|known| known.name() == name)
    }

    fn ask(self, plugins: &mut Plugins, cancel: &Cancel) -> Result<(), String> {
        match self {
            Self::ObjectVisible => match in_sight(plugins)? {
                true => Ok(()),
                false => Err(NOTHING.into()),
            },
            Self::HandEmpty => {
                let here = plugins.robot.state().map_err(|e| e.to_string())?.joints;
                // A gripper tells what it feels at the end of an action: of one that stays.
                let stay = JointTrajectory { period_s: FEEL_S, positions: vec![here; 2] };
                let felt = plugins.robot.execute(&Action::Move(stay), &mut |_| cancel.check());
                match felt.map_err(|e| e.to_string())?.holding {
                    true => Err("something is between the pads".into()),
                    false => Ok(()),
                }
            }
        }
    }
}

/// Whether the camera sees something of an object.
///
/// # Errors
/// When no image could be had.
fn in_sight(plugins: &mut Plugins) -> Result<bool, String> {
    let observation = plugins.camera.observe().map_err(|e| e.to_string())?;
    Ok(!observation.cloud.is_empty())
}

impl Bench {
    /// Whether the camera sees something of an object.
    ///
    /// # Errors
    /// When no image could be had.
    pub(crate) fn object_in_sight(&mut self) -> Result<bool, String> {
        self.timed(Step::Require, |plugins, _| in_sight(plugins)).0
    }
}

/// On a run: what must be true before it looks.
#[derive(Component, Clone, Debug, Default, PartialEq, Eq)]
pub struct Requires(pub Vec<Precondition>);

pub(super) fn require(
    mut commands: Commands,
    mut bench: NonSendMut<Bench>,
    runs: Query<(Entity, &Assignment, &Requires), Without<Failed>>,
) {
    for (run, assignment, requires) in &runs {
        // The hand of a robot that may not move is not asked.
        let asked =
            |asked: &&Precondition| !(assignment.dry_run && **asked == Precondition::HandEmpty);
        let asked: Vec<_> = requires.0.iter().filter(asked).collect();
        if asked.is_empty() {
            continue;
        }
        let cancel = bench.cancel().clone();
        let held = bench.step(Step::Require, |plugins| {
            let told = |asked: &Precondition| {
                asked.ask(plugins, &cancel).map_err(|why| format!("{}: {why}", asked.name()))
            };
            asked.into_iter().try_for_each(told)
        });
        if let Err(failed) = held {
            commands.entity(run).insert(failed);
        }
    }
}
