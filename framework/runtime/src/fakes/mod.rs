//! Stand-ins for every plugin, simple enough to know what a run must make of them.
#![allow(clippy::unwrap_used, reason = "tests")]

mod alignment;
mod cap;
mod cell;
mod solvers;

pub(crate) use alignment::LeastSquares;
pub(crate) use cap::canonical_cloud;
pub(crate) use cell::{Behaviour, FakeCell, leaning, registry, robot_file};
