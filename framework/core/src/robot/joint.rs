//! A revolute joint of the arm.

use crate::Pose;
use nalgebra::{Translation3, Unit, UnitQuaternion, Vector3};

/// A revolute joint with `lower < upper`, finite limits and a positive speed.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    pub(super) name: String,
    pub(super) origin: Pose,
    pub(super) axis: Unit<Vector3<f64>>,
    pub(super) lower: f64,
    pub(super) upper: f64,
    pub(super) velocity: f64,
}

impl Joint {
    /// Its name in the URDF.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Pose of the joint at zero in the frame of the link before it.
    pub fn origin(&self) -> &Pose {
        &self.origin
    }

    /// Axis of rotation in the joint's own frame.
    pub fn axis(&self) -> &Unit<Vector3<f64>> {
        &self.axis
    }

    /// Smallest position, radians.
    pub fn lower(&self) -> f64 {
        self.lower
    }

    /// Largest position, radians.
    pub fn upper(&self) -> f64 {
        self.upper
    }

    /// Largest speed, radians a second.
    pub fn velocity(&self) -> f64 {
        self.velocity
    }

    /// Whether `position` is finite and within the limits.
    pub fn allows(&self, position: f64) -> bool {
        (self.lower..=self.upper).contains(&position)
    }

    /// Pose of the link behind the joint in the frame of the link before it.
    pub fn transform(&self, position: f64) -> Pose {
        let turn = UnitQuaternion::from_axis_angle(&self.axis, position);
        self.origin * Pose::from_parts(Translation3::identity(), turn)
    }
}
