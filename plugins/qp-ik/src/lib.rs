//! Kind `kinematics`: two solvers for the joint positions that bring the tool to a pose.
//!
//! Both descend on the linearised pose error from good starts: [`QpIk`] takes each step
//! from a quadratic program that knows the joint limits, [`DampedLeastSquares`] from the
//! damped normal equations. Descent from one start ends in a local minimum at a joint
//! limit for one target in seven, whatever takes the steps, so the starts come from the
//! closed form where the arm has three parallel joints and an intersecting wrist pair
//! (the UR family), and from seeded draws otherwise. Of several answers, all of the closed form or the
//! first few that draws lead to, the one is taken that touches nothing, is near the start, away from
//! limits and away from singularities.

mod cholesky;
mod closed_form;
mod config;
mod damped;
mod descent;
mod finish;
mod linearised;
mod normal;
mod problem;
mod program;
mod quadratic;
mod rank;
mod reason;
mod search;
mod seeds;
mod solver;
mod subproblem;

#[cfg(test)]
mod tests;

pub use closed_form::ClosedForm;
pub use config::IkConfig;
pub use problem::Problem;
pub use program::QuadraticProgram;
pub use solver::{DampedLeastSquares, QpIk};
