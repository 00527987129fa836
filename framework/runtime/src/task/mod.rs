//! A task: skills put together, carried out by the schedules of a run.
//!
//! Every step of a task is an entity, child of the step that it lies in, with its [`State`];
//! every attempt at a skill is one as well, with all that a run leaves. What is to be done next
//! is found by one system, `decide`, that walks the tree from its root:
//!
//! | work | is done when | has failed when |
//! |---|---|---|
//! | skill | every stage of a run was carried out | a run failed in the last of its tries |
//! | sequence | each step is done | a step has failed; those after it are skipped |
//! | fallback | a step is done; those after it are skipped | each step has failed |
//! | each | it is done with every object | it has failed with any; the others have their turn |
//! | visible | nothing is in sight any more; the other steps are skipped | a step has failed, or something is left after the last |
//!
//! A step that fails and has tries left is begun again, with all that lies in it. A run that
//! follows a failed one first lets go and goes back to where the robot waits
//! ([`Withdraw`](crate::run::Withdraw)). What decides is what the robot itself knows: a stage
//! that failed, fingers that closed on nothing. A verdict is told, and decides nothing, for a
//! real cell has none.

mod cell;
mod decide;
mod node;
mod outcome;
mod run_task;
mod spawn;

pub use cell::{Cell, exchange};
pub use node::{Composition, State};
pub use outcome::{StepOutcome, TaskEvent, TaskOutcome};
pub use run_task::{TaskHooks, run_task};

#[cfg(test)]
mod tests;
