//! The ECS world of a task: its tree, and one run after another.

use super::State;
use super::cell::Cell;
use super::decide::{Around, Next, Root, decide, interrupt};
use super::node::{Composition, Ended, Node, Prepared, Told};
use super::outcome::{TaskEvent, TaskOutcome};
use super::spawn::{Prepare, spawn};
use crate::files::Task;
use crate::plugins::Plugins;
use crate::run::{Bench, Cancel, Hooks, StageEvent, Withdraw, carry_out};
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{ScheduleLabel, SingleThreadedExecutor};
use std::cell::{Cell as Shared, RefCell};
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// What is to be done next; once before every run.
#[derive(ScheduleLabel, Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Decide;

/// What the caller hands in.
pub struct TaskHooks {
    /// Seconds of any clock that only goes forward; for the report's timings alone.
    pub clock: Box<dyn FnMut() -> f64>,
    /// Told of every step as it begins and ends, and of what its runs do.
    pub progress: Box<dyn FnMut(&TaskEvent)>,
    /// Ends the task from outside.
    pub cancel: Cancel,
}

impl Default for TaskHooks {
    /// A clock that stands still, and nobody told.
    fn default() -> Self {
        let cancel = Cancel::default();
        Self { clock: Box::new(|| 0.0), progress: Box::new(|_| {}), cancel }
    }
}

/// Whoever is told of steps and stages.
type Listener = Box<dyn FnMut(&TaskEvent)>;

/// Tells of steps and of stages, and knows how deep the stages lie.
#[derive(Clone)]
pub(super) struct Teller {
    progress: Rc<RefCell<Listener>>,
    depth: Rc<Shared<usize>>,
}

impl Teller {
    pub(super) fn tell(&self, event: &TaskEvent) {
        (self.progress.borrow_mut())(event);
    }

    fn stage(&self, event: &StageEvent) {
        let StageEvent { name, ok, seconds, reason } = event.clone();
        let state = if ok { State::Done } else { State::Failed };
        self.tell(&TaskEvent { depth: self.depth.get(), name, state, seconds, reason });
    }
}

/// Carries out a task. `plugins` are those of its first run, in a cell where the first object
/// lies. Whatever goes wrong in it is told in the outcome.
///
/// # Errors
/// What `prepare` finds wrong with any use of a skill, before anything moves.
pub fn run_task<E>(
    task: &Task,
    prepare: Prepare<E>,
    plugins: Plugins,
    cell: Box<dyn Cell>,
    hooks: TaskHooks,
) -> Result<TaskOutcome, E> {
    let TaskHooks { clock, progress, cancel } = hooks;
    let teller = Teller { progress: Rc::new(RefCell::new(progress)), depth: Rc::default() };
    let stages = teller.clone();
    let progress = Box::new(move |event: &StageEvent| stages.stage(event));
    let hooks = Hooks { clock, progress, cancel: cancel.clone() };
    let mut world = World::new();
    let root = spawn(&mut world, task, prepare)?;
    world.insert_resource(Root(root));
    world.insert_non_send(Bench::new(plugins, hooks));
    world.insert_non_send(Around(cell));
    world.insert_non_send(teller);
    let mut schedule = Schedule::new(Decide);
    schedule.set_executor(SingleThreadedExecutor::new());
    schedule.add_systems(decide);
    let (mut runs, mut failed) = (0, false);
    loop {
        schedule.run(&mut world);
        let Next(Some(step)) = *world.resource::<Next>() else { break };
        runs += 1;
        let ended = run_skill(&mut world, step, runs, failed);
        failed = !ended.done;
        if cancel.is_ordered() {
            interrupt(&mut world, root, &ended.reason);
            break;
        }
        world.entity_mut(step).insert(ended);
    }
    Ok(TaskOutcome::of(&world, root))
}

/// One run of the skill of `step`, the `number`th of the task.
fn run_skill(world: &mut World, step: Entity, number: usize, failed_before: bool) -> Ended {
    let known = "the tree gives every skill its node and its assignment";
    let Node { name, depth, .. } = world.get::<Node>(step).expect(known).clone();
    let Prepared { mut assignment, requires } = world.get::<Prepared>(step).expect(known).clone();
    world.non_send::<Teller>().depth.set(depth + 1);
    let mut around = world.remove_non_send::<Around>().expect("the cell stands around every task");
    let plugins = &mut world.non_send_mut::<Bench>().plugins;
    let equipped = around.0.equip(assignment.methods(), plugins);
    world.insert_non_send(around);
    if let Err(reason) = equipped {
        return Ended { done: false, reason };
    }
    if let Some(object) = object_of(world, step) {
        assignment.object = object;
    }
    assignment.recording = assignment.recording.map(|path| numbered(&path, number, &name));
    let run = world.spawn((assignment, requires, ChildOf(step))).id();
    // With one object after another the hand goes out of the camera's view in between.
    let in_turn = number > 1 && composition_around(world, step) == Some(Composition::Visible);
    if failed_before || in_turn {
        world.entity_mut(run).insert(Withdraw);
    }
    let outcome = carry_out(world, run);
    let done = outcome.failed_at.is_none() && outcome.as_shown != Some(false);
    let ended = Ended { done, reason: outcome.reason.clone() };
    world.entity_mut(run).insert(Told(outcome));
    ended
}

fn composition_around(world: &World, step: Entity) -> Option<Composition> {
    let around = world.get::<ChildOf>(step)?.parent();
    Some(world.get::<Node>(around)?.composition)
}

/// What lies before the robot in `step`: what was laid there as the nearest of the steps around
/// it began; none when that is the first object.
fn object_of(world: &World, step: Entity) -> Option<String> {
    let object = world.get::<Node>(step).and_then(|node| node.object.clone());
    object.or_else(|| object_of(world, world.get::<ChildOf>(step)?.parent()))
}

/// `out/dress.mcap` -> `out/dress-02-wear.mcap`.
fn numbered(path: &Path, number: usize, name: &str) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    path.with_file_name(format!("{stem}-{number:02}-{name}.mcap"))
}
