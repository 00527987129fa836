//! The ECS world and schedule of a run.

use super::act::Again;
use super::assignment::Assignment;
use super::bench::{Bench, Hooks};
use super::check::Checked;
use super::judge::Judged;
use super::outcome::Outcome;
use super::record::Recorded;
use super::step::{Failed, Step};
use super::{Acted, Encoded, Perceived, Planned, Seen, Transferred};
use super::{
    act, check, encode, judge, observe, perceive, plan, record, require, transfer, withdraw,
};
use crate::plugins::Plugins;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::{ScheduleLabel, SingleThreadedExecutor};

/// From what must be true before to what the robot did; once for every try.
#[derive(ScheduleLabel, Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Attempt;

/// The verdict and the recording.
#[derive(ScheduleLabel, Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Conclude;

/// A run that is over.
pub struct Finished {
    /// What is told of it.
    pub outcome: Outcome,
    /// The plugins, for another run of the same cell.
    pub plugins: Plugins,
    /// The run's entity with all that its steps left; see [`Finished::left`].
    world: World,
    run: Entity,
}

impl Finished {
    /// What a step left, e.g. [`super::Planned`] for a picture of the plan.
    pub fn left<C: Component>(&self) -> Option<&C> {
        self.world.get::<C>(self.run)
    }
}

/// Carries out one run. Whatever goes wrong in it is told in the outcome.
pub fn run(assignment: Assignment, plugins: Plugins, hooks: Hooks) -> Finished {
    let mut world = World::new();
    world.insert_non_send(Bench::new(plugins, hooks));
    let run = world.spawn(assignment).id();
    let outcome = carry_out(&mut world, run);
    let bench: Bench = world.remove_non_send().expect("the bench was put there above");
    Finished { outcome, plugins: bench.plugins, world, run }
}

/// Carries out the run of the entity `run` in a world with a bench, and tells of it. A run is
/// under way as long as it has its assignment: what its steps left stays, but no step sees it
/// again.
pub(crate) fn carry_out(world: &mut World, run: Entity) -> Outcome {
    world.non_send_mut::<Bench>().begin();
    let mut attempt = attempt();
    attempt.run(world);
    while again(world, run) {
        attempt.run(world);
    }
    if world.get::<Failed>(run).is_some()
        && world.get::<Assignment>(run).is_some_and(|assignment| !assignment.dry_run)
    {
        world.non_send_mut::<Bench>().stop_robot();
    }
    forgive(world, run);
    conclude().run(world);
    let assignment =
        world.entity_mut(run).take::<Assignment>().expect("no step takes the assignment away");
    Outcome::new(
        &assignment,
        world.non_send::<Bench>(),
        world.get::<Judged>(run).map(|judged| &judged.0),
        world.get::<Acted>(run),
        world.get::<Checked>(run).map(|checked| checked.as_shown),
        world.get::<Failed>(run),
        world.get::<Recorded>(run),
    )
}

/// A try that fails takes nothing back of what one before it carried out to its end: it only was
/// to make it better. Where the object is then, the world will tell.
fn forgive(world: &mut World, run: Entity) {
    let interrupted = world.non_send::<Bench>().cancel().is_ordered();
    if !interrupted && world.get::<Acted>(run).is_some_and(|acted| acted.carried_out) {
        world.entity_mut(run).remove::<Failed>();
    }
}

/// Whether it did not come out and there is another try; what the last one found is then gone,
/// all but what the robot did.
fn again(world: &mut World, run: Entity) -> bool {
    let mut run = world.entity_mut(run);
    if run.take::<Again>().is_none() {
        return false;
    }
    run.remove::<(Seen, Perceived, Encoded, Transferred, Planned)>();
    true
}

/// The steps of one try, one after another on one thread.
pub(super) fn attempt() -> Schedule {
    let mut schedule = Schedule::new(Attempt);
    schedule.set_executor(SingleThreadedExecutor::new());
    schedule.configure_sets(
        (
            Step::Withdraw,
            Step::Require,
            Step::Observe,
            Step::Perceive,
            Step::Encode,
            Step::Transfer,
            Step::Plan,
            Step::Act,
            Step::Check,
        )
            .chain(),
    );
    schedule.add_systems((
        withdraw::withdraw.in_set(Step::Withdraw),
        require::require.in_set(Step::Require),
        observe::observe.in_set(Step::Observe),
        perceive::perceive.in_set(Step::Perceive),
        encode::encode.in_set(Step::Encode),
        transfer::transfer.in_set(Step::Transfer),
        plan::plan.in_set(Step::Plan),
        act::act.in_set(Step::Act),
        check::check.in_set(Step::Check),
    ));
    schedule
}

/// The steps that every run ends with.
pub(super) fn conclude() -> Schedule {
    let mut schedule = Schedule::new(Conclude);
    schedule.set_executor(SingleThreadedExecutor::new());
    schedule.configure_sets((Step::Judge, Step::Record).chain());
    schedule.add_systems((judge::judge.in_set(Step::Judge), record::record.in_set(Step::Record)));
    schedule
}

/// Leaves on a run what a step found, or why it could not.
pub(super) fn leave<C: Component>(commands: &mut Commands, run: Entity, found: Result<C, Failed>) {
    match found {
        Ok(component) => commands.entity(run).insert(component),
        Err(failed) => commands.entity(run).insert(failed),
    };
}
