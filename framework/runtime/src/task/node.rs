//! The components of a task's tree.

use crate::run::{Assignment, Outcome, Requires};
use bevy_ecs::prelude::*;
use serde::Serialize;

/// How far a step has come.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum State {
    /// Not begun.
    #[default]
    Waiting,
    /// Begun and not ended.
    Underway,
    /// Ended well, as far as the robot knows.
    Done,
    /// Ended badly.
    Failed,
    /// Passed over.
    Skipped,
}

impl State {
    /// Whether nothing is to be done any more.
    pub fn is_over(self) -> bool {
        !matches!(self, Self::Waiting | Self::Underway)
    }
}

/// What is done in a step; the parts of it are its children.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Composition {
    /// A skill, whose children are its runs.
    Skill,
    /// One after another, as long as each is done.
    Sequence,
    /// One after another, until one is done.
    Fallback,
    /// One after another, once for each object.
    Each,
    /// One after another, as long as an object is in sight.
    Visible,
}

/// A step of a task as it is carried out.
#[derive(Component, Clone, Debug)]
pub(super) struct Node {
    pub(super) name: String,
    pub(super) composition: Composition,
    /// Steps that it lies in.
    pub(super) depth: usize,
    pub(super) tries: usize,
    /// The object laid before the robot as it begins.
    pub(super) object: Option<String>,
}

/// What has become of a step so far.
#[derive(Component, Clone, Debug, Default)]
pub(super) struct Progress {
    /// How often it was begun.
    pub(super) tries: usize,
    /// When it was first begun, by the clock that was handed in, seconds.
    pub(super) began_s: f64,
    /// How long it took, seconds.
    pub(super) seconds: f64,
    /// Why it failed, or what it ended with.
    pub(super) reason: Option<String>,
}

/// On a skill's step: what each of its runs begins with.
#[derive(Component, Clone)]
pub(super) struct Prepared {
    pub(super) assignment: Assignment,
    pub(super) requires: Requires,
}

/// On a skill's step: how its last run ended, until it has been decided on.
#[derive(Component, Clone, Debug)]
pub(super) struct Ended {
    pub(super) done: bool,
    pub(super) reason: String,
}

/// On a run: what is told of it.
#[derive(Component, Clone, Debug)]
pub(super) struct Told(pub(super) Outcome);
