//! What is to be done next: a walk through the tree from its root.

use super::cell::Cell;
use super::node::{Composition, Ended, Node, Prepared, Progress, State};
use super::outcome::TaskEvent;
use super::run_task::Teller;
use crate::run::{Bench, NOTHING};
use bevy_ecs::prelude::*;

/// The task's root, for the system that walks it.
#[derive(Resource, Clone, Copy)]
pub(super) struct Root(pub(super) Entity);

/// The skill's step that is to be run next; none when the task is over.
#[derive(Resource, Clone, Copy)]
pub(super) struct Next(pub(super) Option<Entity>);

/// The cell, which is asked to lay objects before the robot.
pub(super) struct Around(pub(super) Box<dyn Cell>);

pub(super) fn decide(world: &mut World) {
    let root = world.resource::<Root>().0;
    let next = advance(world, root);
    world.insert_resource(Next(next));
}

/// What has become of a step, as far as it goes without a run.
enum Found {
    /// This skill's step is to be run for it.
    ToRun(Entity),
    /// It ended well, with what.
    Done(Option<String>),
    /// It failed, and why.
    Failed(String),
}

/// Takes a step as far as it goes without a run, and tells the skill's step that is to be run.
fn advance(world: &mut World, step: Entity) -> Option<Entity> {
    match state(world, step) {
        State::Waiting => begin(world, step),
        State::Underway => {}
        State::Done | State::Failed | State::Skipped => return None,
    }
    while state(world, step) == State::Underway {
        let found = match node(world, step).composition {
            Composition::Skill => attempted(world, step),
            composition => composed(world, step, composition),
        };
        match found {
            Found::ToRun(skill) => return Some(skill),
            Found::Done(reason) => end(world, step, State::Done, reason),
            Found::Failed(_) if progress(world, step).tries < node(world, step).tries => {
                again(world, step);
            }
            Found::Failed(reason) => end(world, step, State::Failed, Some(reason)),
        }
    }
    None
}

/// How the last run of a skill ended, which is then decided on.
fn attempted(world: &mut World, step: Entity) -> Found {
    match world.entity_mut(step).take::<Ended>() {
        Some(Ended { done: true, reason }) => Found::Done(Some(reason)),
        Some(Ended { done: false, reason }) => Found::Failed(reason),
        None => Found::ToRun(step),
    }
}

/// How the steps that lie in a step ended, taken together.
fn composed(world: &mut World, step: Entity, composition: Composition) -> Found {
    let (mut last, mut failed) = (None, Vec::new());
    for child in children(world, step) {
        if composition == Composition::Visible && state(world, child) == State::Waiting {
            match in_sight(world) {
                Ok(true) => {}
                Ok(false) => return told_of_all(last.or(Some(NOTHING.into())), failed),
                Err(why) => return Found::Failed(why),
            }
        }
        if let Some(skill) = advance(world, child) {
            return Found::ToRun(skill);
        }
        let done = state(world, child) == State::Done;
        let reason = progress(world, child).reason.clone();
        let told = || format!("{}: {}", node(world, child).name, reason.as_deref().unwrap_or(""));
        match (composition, done) {
            (Composition::Sequence, false) => return Found::Failed(told()),
            (Composition::Fallback, true) => return Found::Done(Some(told())),
            (_, false) => failed.push(told()),
            (_, true) => last = reason,
        }
    }
    // After the last target nothing may be left, but where nothing moves.
    if composition == Composition::Visible && !is_dry(world, step) {
        match in_sight(world) {
            Ok(true) => failed.push("an object is left in sight, but no target for it".into()),
            Ok(false) => {}
            Err(why) => failed.push(why),
        }
    }
    told_of_all(last, failed)
}

fn told_of_all(last: Option<String>, failed: Vec<String>) -> Found {
    if failed.is_empty() { Found::Done(last) } else { Found::Failed(failed.join("; ")) }
}

/// Whether the camera sees an object.
fn in_sight(world: &mut World) -> Result<bool, String> {
    world.non_send_mut::<Bench>().object_in_sight()
}

/// Whether the runs of the skills in `step` stop after planning.
fn is_dry(world: &World, step: Entity) -> bool {
    let prepared = |child: &Entity| world.get::<Prepared>(*child);
    children(world, step).iter().filter_map(prepared).any(|it| it.assignment.dry_run)
}

fn begin(world: &mut World, step: Entity) {
    let now = world.non_send_mut::<Bench>().now();
    world.entity_mut(step).insert(State::Underway);
    if let Some(mut progress) = world.get_mut::<Progress>(step) {
        progress.tries += 1;
        if progress.tries == 1 {
            progress.began_s = now;
        }
    }
    tell(world, step);
    let Some(object) = node(world, step).object.clone() else { return };
    let mut around = world.remove_non_send::<Around>().expect("the cell stands around every task");
    let laid = around.0.present(&object, &mut world.non_send_mut::<Bench>().plugins);
    world.insert_non_send(around);
    match laid {
        Ok(name) => {
            if let Some(mut node) = world.get_mut::<Node>(step) {
                node.object = Some(name);
            }
        }
        Err(why) => {
            end(world, step, State::Failed, Some(format!("{object} cannot be laid there: {why}")));
        }
    }
}

/// Begins a step that failed once more, with all that lies in it.
fn again(world: &mut World, step: Entity) {
    if let Some(mut progress) = world.get_mut::<Progress>(step) {
        progress.tries += 1;
    }
    for child in children(world, step) {
        reset(world, child);
    }
}

fn reset(world: &mut World, step: Entity) {
    world.entity_mut(step).insert((State::Waiting, Progress::default()));
    for child in children(world, step) {
        reset(world, child);
    }
}

fn end(world: &mut World, step: Entity, state: State, reason: Option<String>) {
    let now = world.non_send_mut::<Bench>().now();
    world.entity_mut(step).insert(state);
    if let Some(mut progress) = world.get_mut::<Progress>(step) {
        progress.seconds = now - progress.began_s;
        progress.reason = reason;
    }
    for child in children(world, step) {
        skip(world, child);
    }
    tell(world, step);
}

/// Ends every step that is under way in `step`, and passes over the others.
pub(super) fn interrupt(world: &mut World, step: Entity, reason: &str) {
    for child in children(world, step) {
        interrupt(world, child, reason);
    }
    if state(world, step) == State::Underway {
        end(world, step, State::Failed, Some(reason.to_owned()));
    }
}

/// Passes over what has not begun.
fn skip(world: &mut World, step: Entity) {
    if state(world, step) == State::Waiting {
        world.entity_mut(step).insert(State::Skipped);
        for child in children(world, step) {
            skip(world, child);
        }
        tell(world, step);
    }
}

fn tell(world: &mut World, step: Entity) {
    let (node, progress) = (node(world, step), progress(world, step));
    let event = TaskEvent {
        depth: node.depth,
        name: node.name.clone(),
        state: state(world, step),
        seconds: progress.seconds,
        reason: progress.reason.clone(),
    };
    world.non_send::<Teller>().tell(&event);
}

/// The steps that lie in a step; a skill's runs are none.
fn children(world: &World, step: Entity) -> Vec<Entity> {
    let children = world.get::<Children>(step).into_iter().flatten().copied();
    children.filter(|child| world.get::<Node>(*child).is_some()).collect()
}

fn node(world: &World, step: Entity) -> &Node {
    world.get(step).expect("every step has a node from the first")
}

fn state(world: &World, step: Entity) -> State {
    *world.get(step).expect("every step has a state from the first")
}

fn progress(world: &World, step: Entity) -> &Progress {
    world.get(step).expect("every step has its progress from the first")
}
