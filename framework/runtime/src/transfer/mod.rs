//! The geometry around the plugins: from a gripper pose in the world to the canonical
//! state and back, and from the grasp to every later stage (method: Eq. 6 to 9).
//!
//! Canonical poses (`H`) have their translation in units of the canonical cube; world
//! poses (`T`) are metres.

mod carry;
mod gripper_points;
mod placement;
mod surface;
mod taken;
mod turn;

pub use carry::{ANCHOR, Held, carried, relation};
pub use gripper_points::gripper_points;
pub use placement::{LocalFit, Placement};
pub use surface::{brought_to_edge, edge_before_palm, laid_on_surface};
pub use taken::takes;
pub use turn::{TILTS_DEG, Turn, turns};

#[cfg(test)]
mod tests;
