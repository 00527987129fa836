//! What is told of a task.

use super::node::{Composition, Node, Progress, State, Told};
use crate::run::Outcome;
use bevy_ecs::prelude::*;
use serde::Serialize;

/// A step of a task, or a step or stage of one of its runs, as it begins or ends.
#[derive(Clone, Debug, PartialEq)]
pub struct TaskEvent {
    /// Steps that it lies in; zero for the task.
    pub depth: usize,
    /// Its name.
    pub name: String,
    /// [`State::Underway`] as it begins.
    pub state: State,
    /// How long it took, seconds; zero as it begins.
    pub seconds: f64,
    /// Why it failed, or what it ended with.
    pub reason: Option<String>,
}

/// What is told of a task: the one object that `run --json` prints.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TaskOutcome {
    /// The task's name.
    pub task: String,
    /// Every step done, and every run that it was done by within its skill's tolerance; `None`
    /// when nobody could tell, as after a dry run.
    pub success: Option<bool>,
    /// Why it failed, or what it ended with.
    pub reason: String,
    /// The steps.
    pub tree: StepOutcome,
}

/// What is told of a step.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StepOutcome {
    /// Its name.
    pub name: String,
    /// What is done in it.
    pub composition: Composition,
    /// How it ended.
    pub state: State,
    /// The object that was laid before the robot as it began.
    pub object: Option<String>,
    /// How often it was begun since the step that it lies in was.
    pub tries: usize,
    /// How long these tries took together, seconds by the clock that was handed in.
    pub seconds: f64,
    /// Why it failed, or what it ended with.
    pub reason: Option<String>,
    /// The runs of a skill, in order.
    pub runs: Vec<Outcome>,
    /// The steps that lie in it.
    pub steps: Vec<StepOutcome>,
}

impl TaskOutcome {
    pub(super) fn of(world: &World, root: Entity) -> Self {
        let tree = StepOutcome::of(world, root);
        let success = match tree.state {
            State::Done => tree.verdict(),
            _ => Some(false),
        };
        Self {
            task: tree.name.clone(),
            success,
            reason: tree.reason.clone().unwrap_or_default(),
            tree,
        }
    }
}

impl StepOutcome {
    fn of(world: &World, step: Entity) -> Self {
        let known = "every step has a node, a state and its progress from the first";
        let node = world.get::<Node>(step).expect(known);
        let progress = world.get::<Progress>(step).expect(known);
        let children: Vec<Entity> =
            world.get::<Children>(step).into_iter().flatten().copied().collect();
        let runs = children.iter().filter_map(|run| world.get::<Told>(*run));
        let steps = children.iter().filter(|child| world.get::<Node>(**child).is_some());
        Self {
            name: node.name.clone(),
            composition: node.composition,
            state: *world.get::<State>(step).expect(known),
            object: node.object.clone(),
            tries: progress.tries,
            seconds: progress.seconds,
            reason: progress.reason.clone(),
            runs: runs.map(|told| told.0.clone()).collect(),
            steps: steps.map(|step| Self::of(world, *step)).collect(),
        }
    }

    /// Whether what is done was done well: by its last run, or by every step that is done.
    fn verdict(&self) -> Option<bool> {
        if let Some(run) = self.runs.last() {
            return run.success;
        }
        let done = self.steps.iter().filter(|step| step.state == State::Done);
        done.map(Self::verdict).try_fold(true, |all, one| one.map(|one| all && one))
    }
}
