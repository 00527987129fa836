//! A head: cranium, ears and neck.

use crate::contact::capsule::Capsule;
use crate::contact::ellipsoid::Ellipsoid;
use crate::contact::{Body, Probes, Shape};
use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use seeone_core::{HeadSize, Pose};

/// Middle of the right ear and its semi-axes, as shares of the cranium's semi-axes: on the
/// medium head 36 mm wide and 60 mm long, standing off by 14 mm, its top 5 mm below the
/// widest level, where hats do not reach that are not pulled down.
const EAR: [[f64; 3]; 2] = [[0.94, -0.12, -0.32], [0.18, 0.18, 0.275]];
/// Upper and lower end of the neck's axis, as shares of the semi-axes.
const NECK: [[f64; 3]; 2] = [[0.0, -0.15, -0.60], [0.0, -0.30, -1.35]];
/// Radius of the neck as a share of the cranium's breadth: on the medium head a
/// circumference of 0.39 m.
const NECK_RADIUS: f64 = 0.81;

/// A head: its origin at the middle of the cranium, z up and the face along +y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Head {
    /// Head frame -> world.
    pub pose: Pose,
    /// How large it is.
    pub size: HeadSize,
}

impl Head {
    /// A head of medium size.
    pub fn medium(pose: Pose) -> Self {
        Self { pose, size: HeadSize::MEDIUM }
    }

    /// The cranium in the head frame.
    pub fn cranium(&self) -> Ellipsoid {
        Ellipsoid { semi_axes: self.size.semi_axes_m() }
    }

    /// Middle (head frame) and semi-axes of either ear, metres.
    pub fn ears(&self) -> [(Point3<f64>, Vector3<f64>); 2] {
        let [middle, semi_axes] = EAR.map(|share| self.share(share));
        let mirrored = Point3::new(-middle.x, middle.y, middle.z);
        [Point3::from(middle), mirrored].map(|middle| (middle, semi_axes))
    }

    /// Ends of the neck's axis (head frame), upper first, and its radius, metres.
    pub fn neck(&self) -> ([Point3<f64>; 2], f64) {
        (NECK.map(|share| Point3::from(self.share(share))), NECK_RADIUS * self.size.semi_axes_m().x)
    }

    fn share(&self, share: [f64; 3]) -> Vector3<f64> {
        Vector3::from(share).component_mul(&self.size.semi_axes_m())
    }

    /// Cranium, ears and neck in world.
    pub(crate) fn bodies(&self, friction: f64) -> Vec<Body> {
        let ([top, bottom], radius) = self.neck();
        let axis = bottom - top;
        // The shortest turn is undefined for opposite vectors alone; a neck never points up.
        let turn = UnitQuaternion::rotation_between(&-Vector3::z(), &axis).unwrap_or_default();
        let neck = Capsule { half_length: axis.norm() / 2.0, radius };
        let middle = Translation3::from(nalgebra::center(&top, &bottom).coords);
        let body = |shape, placed: Pose, probes| Body {
            shape,
            pose: self.pose * placed,
            friction,
            probes,
        };
        let cranium = Shape::Ellipsoid(self.cranium());
        let mut bodies = vec![body(cranium, Pose::identity(), Probes::Vertices)];
        bodies.extend(self.ears().map(|(middle, semi_axes)| {
            let placed = Pose::from_parts(middle.into(), UnitQuaternion::identity());
            body(Shape::Ellipsoid(Ellipsoid { semi_axes }), placed, Probes::Samples)
        }));
        let placed = Pose::from_parts(middle, turn);
        bodies.push(body(Shape::Capsule(neck), placed, Probes::Vertices));
        bodies
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ears_stand_off_below_the_widest_level_and_the_neck_is_under_the_head() {
        for (name, size) in HeadSize::NAMED {
            let head = Head { pose: Pose::identity(), size };
            for (middle, semi_axes) in head.ears() {
                let outermost =
                    Point3::new(middle.x + middle.x.signum() * semi_axes.x, middle.y, middle.z);
                let off = head.cranium().signed_distance(&outermost).0;
                assert!((0.010..0.018).contains(&off), "{name}: an ear stands off by {off} m");
                assert!(middle.z + semi_axes.z < 0.0, "{name}: an ear reaches the hat line");
            }
            let ([top, bottom], radius) = head.neck();
            assert!(head.cranium().contains(&top) && !head.cranium().contains(&bottom));
            assert!(radius < size.semi_axes_m().x);
        }
    }
}
