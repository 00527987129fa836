//! What is in the world beside the object and the hand.

use crate::contact::ellipsoid::Ellipsoid;
use nalgebra::Vector3;
use seeone_core::Pose;

/// Semi-axes of the head, metres, along its x (ear to ear), y (where the face looks) and
/// z (up): a circumference of 0.556 m.
pub const HEAD_SEMI_AXES_M: [f64; 3] = [0.077, 0.099, 0.110];

/// A head: an ellipsoid with its origin at the centre, z up and the face along +y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Head {
    /// Head frame -> world.
    pub pose: Pose,
}

impl Head {
    /// Its shape in its own frame.
    pub fn shape() -> Ellipsoid {
        Ellipsoid { semi_axes: Vector3::from(HEAD_SEMI_AXES_M) }
    }
}

/// Coulomb friction coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frictions {
    /// Fabric on the mat that covers the table.
    pub table: f64,
    /// Fabric on the head.
    pub head: f64,
    /// Fabric on the gripper's rubber pads.
    pub pad: f64,
}

impl Default for Frictions {
    fn default() -> Self {
        Self { table: 0.5, head: 0.5, pad: 0.8 }
    }
}

/// The rigid surroundings.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Surroundings {
    /// Whether there is a table, its top at z = 0.
    pub table: bool,
    /// A head, if any.
    pub head: Option<Head>,
    /// Friction with each of them.
    pub frictions: Frictions,
}
