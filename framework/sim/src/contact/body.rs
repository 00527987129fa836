//! A rigid body at rest: a smooth shape at a pose, with its friction.

use super::Touch;
use super::capsule::Capsule;
use super::ellipsoid::Ellipsoid;
use nalgebra::{Point3, Vector3};
use seeone_core::Pose;

/// See [`Body::rolling_arm_m`]; design value.
const ROLLING_ARM_M: f64 = 5.0e-4;

/// A smooth shape in its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// About the origin.
    Ellipsoid(Ellipsoid),
    /// Along the z axis.
    Capsule(Capsule),
    /// Everything at and below z = 0.
    HalfSpace,
}

impl Shape {
    /// Distance of `p` from the surface in metres, negative inside, and the outward unit
    /// normal at the nearest surface point.
    #[inline]
    pub fn signed_distance(&self, p: &Point3<f64>) -> (f64, Vector3<f64>) {
        match self {
            Self::Ellipsoid(ellipsoid) => ellipsoid.signed_distance(p),
            Self::Capsule(capsule) => capsule.signed_distance(p),
            Self::HalfSpace => (p.z, Vector3::z()),
        }
    }

    /// Whether `p` may be nearer to the surface than `reach` metres, or inside. Cheap, and
    /// never wrong when it says no.
    #[inline]
    fn may_reach(&self, p: &Point3<f64>, reach: f64) -> bool {
        match self {
            // A ball of this radius lies in the ellipsoid scaled by reach / (smallest
            // semi-axis), so their sum lies in this one.
            Self::Ellipsoid(ellipsoid) => {
                let semi_axes = ellipsoid.semi_axes;
                let scaled = p.coords.component_div(&semi_axes).norm();
                scaled < 1.0 + reach / semi_axes.min()
            }
            Self::Capsule(_) | Self::HalfSpace => self.signed_distance(p).0 < reach,
        }
    }

    /// Depth of `p` below the surface and the outward normal there, when it is inside.
    #[inline]
    fn inside(&self, p: &Point3<f64>) -> Option<(f64, Vector3<f64>)> {
        if let Self::Ellipsoid(ellipsoid) = self
            && !ellipsoid.contains(p)
        {
            return None;
        }
        let (distance, normal) = self.signed_distance(p);
        (distance < 0.0).then_some((-distance, normal))
    }
}

/// What points of a shell a body has to be kept from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Probes {
    /// The vertices: the body is wide and blunt beside a triangle.
    Vertices,
    /// Edge midpoints and triangle centroids as well: it could pass between vertices.
    Samples,
}

/// A rigid body at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// In the body frame.
    pub shape: Shape,
    /// Body frame -> world.
    pub pose: Pose,
    /// Coulomb friction coefficient of its surface with fabric.
    pub friction: f64,
    /// What it touches the shell with.
    pub probes: Probes,
}

impl Body {
    /// Lever arm of its rolling resistance, metres. A flat support alone has one: a dome of
    /// fabric on a soft mat flattens by so much more in front of the contact than behind
    /// it. On a head or a peg an object does not roll, it sits.
    pub fn rolling_arm_m(&self) -> f64 {
        if self.shape == Shape::HalfSpace { ROLLING_ARM_M } else { 0.0 }
    }

    /// Distance of `p` (world) from the surface in metres, negative inside.
    pub fn distance(&self, p: &Point3<f64>) -> f64 {
        self.shape.signed_distance(&self.pose.inverse_transform_point(p)).0
    }

    /// Whether the point `p` (world) may be nearer to the body than `reach` metres. Cheap,
    /// and never wrong when it says no.
    #[inline]
    pub fn may_reach(&self, p: &Point3<f64>, reach: f64) -> bool {
        self.shape.may_reach(&self.pose.inverse_transform_point(p), reach)
    }

    /// Where the body touches the point `p` (world), if it is inside.
    #[inline]
    pub fn touch(&self, p: &Point3<f64>) -> Option<Touch> {
        let (depth, normal) = self.shape.inside(&self.pose.inverse_transform_point(p))?;
        Some(Touch { normal: self.pose.rotation * normal, depth, carried: Vector3::zeros() })
    }
}
