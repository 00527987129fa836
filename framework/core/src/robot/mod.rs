//! The robot: a serial arm with a two-finger gripper, read from a URDF and checked.
//!
//! An arm of `n` joints has `n + 1` links: the base, then one behind each joint. Links
//! that the URDF joins by fixed joints are one link here. Joint positions are radians,
//! one a joint, base first.

mod build;
mod gripper;
mod joint;
mod model;
mod solid;
mod tessellate;
mod urdf;

#[cfg(test)]
mod tests;

pub use build::{RobotDescription, RobotOptions};
pub use gripper::{Finger, GripperModel, GripperOptions};
pub use joint::Joint;
pub use model::{Link, RobotModel};
pub use solid::{Shape, Solid};
