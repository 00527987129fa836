//! The simple bodies that stand for a link in collision checks and pictures.

use crate::Pose;
use nalgebra::Vector3;

/// A body about its own centre; every length is positive and finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A box with edges along the axes.
    Box {
        /// Half of each edge, metres.
        half_m: Vector3<f64>,
    },
    /// A cylinder along z.
    Cylinder {
        /// Radius, metres.
        radius_m: f64,
        /// Length, metres.
        length_m: f64,
    },
    /// A cylinder along z with a half ball on either end.
    Capsule {
        /// Radius, metres.
        radius_m: f64,
        /// Length of the cylinder without the half balls, metres.
        length_m: f64,
    },
    /// A ball.
    Sphere {
        /// Radius, metres.
        radius_m: f64,
    },
}

/// A shape at its place in a link.
#[derive(Clone, Debug, PartialEq)]
pub struct Solid {
    /// Name of the URDF link it belongs to.
    pub part: String,
    /// The body.
    pub shape: Shape,
    /// Pose of its centre in the link's frame.
    pub pose: Pose,
}
