//! What the robot touches at a posture: itself, the table, obstacles, and what hangs in its
//! hand against both. Bodies are convex; distances are parry's, or of two segments where that
//! says all.
//!
//! A room of its own because solvers of two kinds and the binary need it, and it alone needs
//! parry.

mod body;
mod checker;
mod convex;
mod pairs;
mod rules;
mod segment;

#[cfg(test)]
mod tests;

pub use checker::Checker;
pub use convex::{Convex, Placed};
pub use pairs::{Pairs, SAMPLES, sampled};
pub use rules::{Margins, Room, Rules};
