//! What is to be done next: a walk through the tree from its root.

use super::cell::Cell;
use super::node::{Composition, Ended, Node, Progress, State};
use super::outcome::TaskEvent;
use super::run_task::Teller;
use crate::run::Bench;
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

/// Takes a step as far as it goes without a run, and tells the skill's step that is to be run.
fn advance(world: &mut World, step: Entity) -> Option<Entity> {
    match state(world, step) {
        State::Waiting => begin(world, step),
        State::Underway => {}
        State::Done | State::Failed | State::Skipped => return None,
    }
    while state(world, step) == State::Underway {
        let ended = if node(world, step).composition == Composition::Skill {
            match world.entity_mut(step).take::<Ended>() {
                Some(Ended { done: true, reason }) => Ok(Some(reason)),
                Some(Ended { done: false, reason }) => Err(reason),
                None => return Some(step),
            }
        } else {
            match compose(world, step) {
                Ok(ended) => ended,
                Err(next) => return Some(next),
            }
        };
        match ended {
            Ok(reason) => end(world, step, State::Done, reason),
            Err(_) if progress(world, step).tries < node(world, step).tries => again(world, step),
            Err(reason) => end(world, step, State::Failed, Some(reason)),
        }
    }
    None
}

/// How a step of steps ended: well, or why not; or else what is to be run for it.
fn compose(world: &mut World, step: Entity) -> Result<Result<Option<String>, String>, Entity> {
    let composition = node(world, step).composition;
    let (mut last, mut failed) = (None, Vec::new());
    for child in children(world, step) {
        if let Some(next) = advance(world, child) {
            return Err(next);
        }
        let done = state(world, child) == State::Done;
        let Progress { reason, .. } = progress(world, child).clone();
        let told = || format!("{}: {}", node(world, child).name, reason.as_deref().unwrap_or(""));
        match (composition, done) {
            (Composition::Sequence, false) => return Ok(Err(told())),
            (Composition::Fallback, true) => return Ok(Ok(Some(told()))),
            (_, false) => failed.push(told()),
            (_, true) => last = reason,
        }
    }
    Ok(match failed[..] {
        [] => Ok(last),
        _ => Err(failed.join("; ")),
    })
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
