//! One run of a skill: an entity to which each step adds what it found.
//!
//! | step | takes | leaves |
//! |---|---|---|
//! | withdraw | a run that follows a failed one | the hand empty, back where it waits |
//! | require | what must be true before | nothing |
//! | observe | scene, camera | [`Seen`] |
//! | perceive | both clouds | [`Perceived`] |
//! | encode | both canonical clouds | [`Encoded`] |
//! | transfer | both fields | [`Transferred`] |
//! | plan | candidates, robot, scene | [`Planned`] |
//! | act | program | [`Acted`] |
//! | check | the result that was shown | [`Checked`] |
//! | judge | the world | [`Judged`] |
//! | record | all of it | a recording |
//!
//! A step that cannot do its work leaves [`Failed`], and the steps after it are passed over;
//! judging and recording are not, so that every run ends with a verdict and a whole file.
//! The first is for what follows a run or a try that failed, the second for runs of a
//! [`task`](crate::task) alone.
//! Withdraw to check are one schedule, made again when it did not come out; judge and record
//! are another. Both are single-threaded and chained; no step reads a clock but the one that is
//! handed in, and nothing of that goes into a recording.

mod act;
mod assignment;
mod bench;
mod cancel;
mod check;
mod encode;
mod execution;
mod hull;
mod judge;
mod key_poses;
mod observe;
mod onward;
mod outcome;
mod perceive;
mod plan;
mod record;
mod require;
mod schedule;
mod step;
mod transfer;
mod withdraw;

pub use act::{Acted, Snapshot};
pub use assignment::Assignment;
pub use bench::Hooks;
pub use cancel::Cancel;
pub use check::Checked;
pub use encode::Encoded;
pub use execution::{Ended, Execution};
pub use hull::Hull;
pub use judge::Judged;
pub use observe::Seen;
pub use outcome::Outcome;
pub use perceive::Perceived;
pub use plan::Planned;
pub use require::{Precondition, Requires};
pub use schedule::{Finished, run};
pub use step::{Failed, StageEvent, Step};
pub use transfer::{Grasp, Transferred};
pub use withdraw::Withdraw;

pub(crate) use bench::Bench;
pub(crate) use observe::NOTHING;
pub(crate) use schedule::carry_out;

#[cfg(test)]
mod tests;
