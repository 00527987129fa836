//! What is in the world beside the object and the hand.

mod head;
mod hook;

pub use head::Head;
pub use hook::Hook;

use crate::contact::{Body, Probes, Shape};
pub use seeone_core::Peg;
pub use seeone_core::head::{HEAD_SEMI_AXES_M, HeadSize};

use seeone_core::Pose;

/// Coulomb friction coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frictions {
    /// Fabric on the mat that covers the table.
    pub table: f64,
    /// Fabric on the head.
    pub head: f64,
    /// Fabric on the hook's wood and on the wall behind it.
    pub hook: f64,
    /// Fabric on the gripper's rubber pads.
    pub pad: f64,
}

impl Default for Frictions {
    fn default() -> Self {
        Self { table: 0.5, head: 0.5, hook: 0.3, pad: 0.8 }
    }
}

/// The rigid surroundings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Surroundings {
    /// Whether there is a table, its top at z = 0.
    pub table: bool,
    /// A head, if any.
    pub head: Option<Head>,
    /// Hooks, each on its wall, if any.
    pub hooks: Vec<Hook>,
    /// Friction with each of them.
    pub frictions: Frictions,
}

impl Surroundings {
    /// Everything in it that an object may touch.
    pub(crate) fn bodies(&self) -> Vec<Body> {
        let head = self.head.map(|head| head.bodies(self.frictions.head));
        let hooks = self.hooks.iter().flat_map(|hook| hook.bodies(self.frictions.hook));
        let table = self.table.then(|| half_space(Pose::identity(), self.frictions.table));
        head.into_iter().flatten().chain(hooks).chain(table).collect()
    }
}

/// Everything at and below the plane z = 0 of `pose`.
fn half_space(pose: Pose, friction: f64) -> Body {
    Body { shape: Shape::HalfSpace, pose, friction, probes: Probes::Vertices }
}
