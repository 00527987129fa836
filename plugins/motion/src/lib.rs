//! Kind `motion`: two planners from key poses to a program of joint trajectories.
//!
//! Around every key pose the tool moves on straight lines (approach, lift, retreat, and
//! from one key pose to the next where nothing lies between them). Between those the arm
//! moves freely: [`Planner`] goes straight in joint space where that is free and plans
//! around obstacles with RRT-Connect where it is not; [`JointLine`] goes straight or
//! refuses.

mod candidates;
mod config;
mod failure;
mod hand;
mod line;
mod plan;
mod planner;
mod profile;
mod rrt;
mod script;
mod spline;
mod timing;
mod transit;
mod walk;

#[cfg(test)]
mod tests;

pub use config::MotionConfig;
pub use planner::{JointLine, Planner};
