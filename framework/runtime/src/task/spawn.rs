//! From a task to its tree of entities.

use super::node::{Composition, Node, Prepared, Progress, State};
use crate::files::{SkillUse, Task, TaskStep, Work};
use crate::run::{Assignment, Requires};
use bevy_ecs::prelude::*;

/// Makes an assignment of a use of a skill.
pub(super) type Prepare<'a, E> = &'a mut dyn FnMut(&SkillUse) -> Result<Assignment, E>;

/// Spawns the tree with every assignment prepared, so that whatever can be found wrong before
/// anything moves is; its root.
pub(super) fn spawn<E>(world: &mut World, task: &Task, prepare: Prepare<E>) -> Result<Entity, E> {
    let root = Node {
        name: task.name.clone(),
        composition: Composition::Sequence,
        depth: 0,
        tries: 1,
        object: None,
    };
    let root = world.spawn((root, State::default(), Progress::default())).id();
    task.steps.iter().try_for_each(|step| spawn_step(world, step, root, 1, prepare))?;
    Ok(root)
}

fn spawn_step<E>(
    world: &mut World,
    step: &TaskStep,
    parent: Entity,
    depth: usize,
    prepare: Prepare<E>,
) -> Result<(), E> {
    if let [_, _, ..] = step.objects[..] {
        let each = Node {
            name: step.name.clone(),
            composition: Composition::Each,
            depth,
            tries: 1,
            object: None,
        };
        let each = world.spawn((each, State::default(), Progress::default(), ChildOf(parent))).id();
        for object in &step.objects {
            let name = format!("{}-{object}", step.name);
            let one = TaskStep { name, objects: vec![object.clone()], ..step.clone() };
            spawn_step(world, &one, each, depth + 1, prepare)?;
        }
        return Ok(());
    }
    let composition = match &step.work {
        Work::Skill(_) => Composition::Skill,
        Work::Sequence(_) => Composition::Sequence,
        Work::Fallback(_) => Composition::Fallback,
        Work::Visible(_) => Composition::Visible,
    };
    let node = Node {
        name: step.name.clone(),
        composition,
        depth,
        tries: step.tries,
        object: step.objects.first().cloned(),
    };
    let node = world.spawn((node, State::default(), Progress::default(), ChildOf(parent))).id();
    match &step.work {
        Work::Skill(used) => {
            let (assignment, requires) = (prepare(used)?, Requires(used.requires.clone()));
            world.entity_mut(node).insert(Prepared { assignment, requires });
            Ok(())
        }
        work => {
            let mut steps = work.steps().iter();
            steps.try_for_each(|step| spawn_step(world, step, node, depth + 1, prepare))
        }
    }
}
