//! Convex bodies and the distances between them.

use nalgebra::{Point3, Vector3};
use parry3d_f64::math::{Pose as ParryPose, Rotation, Vector};
use parry3d_f64::query::details::distance_support_map_support_map;
use parry3d_f64::shape::SupportMap;
use seeone_core::Pose;
use seeone_core::robot::Shape;

/// A convex body about its own centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Core {
    /// A line along z of half this length; zero for a point.
    Segment(f64),
    /// A box with these half edges.
    Box(Vector3<f64>),
    /// A cylinder along z.
    Cylinder { radius: f64, half: f64 },
    /// An ellipsoid with these semi-axes.
    Ellipsoid(Vector3<f64>),
}

/// A convex body grown by a radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Convex {
    core: Core,
    radius: f64,
}

impl Convex {
    /// A ball.
    pub(crate) fn ball(radius: f64) -> Self {
        Self { core: Core::Segment(0.0), radius }
    }

    /// An ellipsoid with these semi-axes.
    pub(crate) fn ellipsoid(semi_axes: Vector3<f64>) -> Self {
        Self { core: Core::Ellipsoid(semi_axes), radius: 0.0 }
    }

    /// Radius of a ball about the centre that holds the body.
    pub(crate) fn bound(&self) -> f64 {
        let core = match self.core {
            Core::Segment(half) => half,
            Core::Box(half) => half.norm(),
            Core::Cylinder { radius, half } => radius.hypot(half),
            Core::Ellipsoid(semi_axes) => semi_axes.amax(),
        };
        core + self.radius
    }

    /// Height of its lowest point along the world's z, at `pose`.
    pub(crate) fn lowest(&self, pose: &Pose) -> f64 {
        let down = pose.rotation.inverse_transform_vector(&-Vector3::z());
        (pose * Point3::from(self.core.support(&down))).z - self.radius
    }

    /// Distance from another body, both at poses in one frame; negative by the grown
    /// radii at most when they overlap.
    pub(crate) fn distance(&self, pose: &Pose, other: &Self, other_pose: &Pose) -> f64 {
        let relative = parry_pose(&pose.inv_mul(other_pose));
        let apart = distance_support_map_support_map(&relative, &self.core, &other.core);
        apart - self.radius - other.radius
    }
}

impl From<&Shape> for Convex {
    fn from(shape: &Shape) -> Self {
        match *shape {
            Shape::Box { half_m } => Self { core: Core::Box(half_m), radius: 0.0 },
            Shape::Cylinder { radius_m, length_m } => {
                let core = Core::Cylinder { radius: radius_m, half: 0.5 * length_m };
                Self { core, radius: 0.0 }
            }
            Shape::Capsule { radius_m, length_m } => {
                Self { core: Core::Segment(0.5 * length_m), radius: radius_m }
            }
            Shape::Sphere { radius_m } => Self::ball(radius_m),
        }
    }
}

impl Core {
    /// Its furthest point along `direction`, which need not be of unit length.
    fn support(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        match *self {
            Self::Segment(half) => Vector3::new(0.0, 0.0, half.copysign(direction.z)),
            Self::Box(half) => half.zip_map(direction, f64::copysign),
            Self::Cylinder { radius, half } => {
                let across = direction.x.hypot(direction.y);
                let scale = if across > 0.0 { radius / across } else { 0.0 };
                Vector3::new(direction.x * scale, direction.y * scale, half.copysign(direction.z))
            }
            Self::Ellipsoid(semi_axes) => {
                let scaled = semi_axes.component_mul(direction);
                let length = scaled.norm();
                if length > 0.0 { semi_axes.component_mul(&scaled) / length } else { scaled }
            }
        }
    }
}

impl SupportMap for Core {
    fn local_support_point(&self, direction: Vector) -> Vector {
        let support = self.support(&Vector3::new(direction.x, direction.y, direction.z));
        Vector::new(support.x, support.y, support.z)
    }
}

fn parry_pose(pose: &Pose) -> ParryPose {
    let (t, q) = (&pose.translation.vector, &pose.rotation.coords);
    ParryPose::from_parts(Vector::new(t.x, t.y, t.z), Rotation::from_xyzw(q.x, q.y, q.z, q.w))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Translation3, UnitQuaternion};
    use seeone_core::random::{direction, generator, rotation, uniform};

    #[test]
    fn distances_are_those_of_simple_cases() {
        let at = |x: f64, y: f64, z: f64| Pose::translation(x, y, z);
        let cube = Convex::from(&Shape::Box { half_m: Vector3::repeat(0.1) });
        let capsule = Convex::from(&Shape::Capsule { radius_m: 0.05, length_m: 0.2 });
        let head = Convex::ellipsoid(Vector3::new(0.077, 0.099, 0.110));
        let origin = Pose::identity();
        assert!((cube.distance(&origin, &capsule, &at(0.3, 0.0, 0.1)) - 0.15).abs() < 1e-6);
        assert!(
            (head.distance(&origin, &Convex::ball(0.02), &at(0.0, 0.0, 0.2)) - 0.07).abs() < 1e-6
        );
        assert!((head.distance(&origin, &capsule, &at(0.0, -0.2, 0.0)) - 0.051).abs() < 1e-6);
        assert!(cube.distance(&origin, &capsule, &at(0.1, 0.0, 0.0)) < 0.0);
        let lying = Pose::from_parts(
            Translation3::new(0.0, 0.0, 1.0),
            UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::FRAC_PI_2),
        );
        assert!((capsule.lowest(&lying) - 0.95).abs() < 1e-12);
        assert!((capsule.lowest(&origin) + 0.15).abs() < 1e-12);
    }

    #[test]
    fn the_search_for_the_distance_from_an_ellipsoid_converges() {
        let head = Convex::ellipsoid(Vector3::new(0.077, 0.099, 0.110));
        let mut rng = generator(4, "ellipsoid");
        for _ in 0..2000 {
            let away = direction(&mut rng) * uniform(&mut rng, 0.3, 0.9);
            let pose = Pose::from_parts(away.into(), rotation(&mut rng));
            let palm = Convex::from(&Shape::Box { half_m: Vector3::new(0.033, 0.044, 0.055) });
            let distance = palm.distance(&pose, &head, &Pose::identity());
            let (low, high) = (away.norm() - palm.bound() - head.bound(), away.norm() - 0.11);
            assert!((low..high).contains(&distance), "{distance} not in {low}..{high}");
        }
    }
}
