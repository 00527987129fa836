//! A head: cranium, ears and neck.

use crate::contact::capsule::Capsule;
use crate::contact::ellipsoid::Ellipsoid;
use crate::contact::{Body, Resolution, Shape};
use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use seeone_core::Pose;

/// Semi-axes of the medium head's cranium, metres, along x (ear to ear), y (where the face
/// looks) and z (up): a breadth of 154 mm and a length of 198 mm, the means of men in
/// ANSUR II within a millimetre. As an ellipse they give a circumference of 0.555 m.
pub const HEAD_SEMI_AXES_M: [f64; 3] = [0.077, 0.099, 0.110];

/// Smallest and largest semi-axis of a head, metres: circumferences well beyond the 0.445
/// to 0.645 m that EN 960 has head forms for.
const SEMI_AXIS_M: [f64; 2] = [0.05, 0.15];

/// Middle of the right ear and its semi-axes, as shares of the cranium's semi-axes: on the
/// medium head 36 mm wide and 60 mm long, standing off by 14 mm, its top 5 mm below the
/// widest level, where hats do not reach that are not pulled down.
const EAR: [[f64; 3]; 2] = [[0.94, -0.12, -0.32], [0.18, 0.18, 0.275]];
/// Upper and lower end of the neck's axis, as shares of the semi-axes.
const NECK: [[f64; 3]; 2] = [[0.0, -0.15, -0.60], [0.0, -0.30, -1.35]];
/// Radius of the neck as a share of the cranium's breadth: on the medium head a
/// circumference of 0.39 m.
const NECK_RADIUS: f64 = 0.81;

/// How large a head is: the semi-axes of its cranium. Ears and neck grow with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadSize {
    semi_axes_m: [f64; 3],
}

impl HeadSize {
    /// A circumference of 0.535 m.
    pub const SMALL: Self = Self::scaled(0.535);
    /// A circumference of 0.555 m.
    pub const MEDIUM: Self = Self { semi_axes_m: HEAD_SEMI_AXES_M };
    /// A circumference of 0.580 m.
    pub const LARGE: Self = Self::scaled(0.580);
    /// The sizes with their names.
    pub const NAMED: [(&'static str, Self); 3] =
        [("small", Self::SMALL), ("medium", Self::MEDIUM), ("large", Self::LARGE)];

    /// The medium head scaled to a circumference.
    const fn scaled(circumference_m: f64) -> Self {
        let [x, y, z] = HEAD_SEMI_AXES_M;
        let scale = circumference_m / 0.5551;
        Self { semi_axes_m: [x * scale, y * scale, z * scale] }
    }

    /// The size of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::NAMED.into_iter().find(|(known, _)| *known == name).map(|(_, size)| size)
    }

    /// A cranium of these semi-axes in metres; `None` when one of them is not that of a
    /// head.
    pub fn of_semi_axes(semi_axes_m: [f64; 3]) -> Option<Self> {
        let possible = |a: &f64| (SEMI_AXIS_M[0]..=SEMI_AXIS_M[1]).contains(a);
        semi_axes_m.iter().all(possible).then_some(Self { semi_axes_m })
    }

    /// Semi-axes of the cranium along the head's x, y and z, metres.
    pub fn semi_axes_m(&self) -> Vector3<f64> {
        Vector3::from(self.semi_axes_m)
    }

    /// Length around the widest level, metres (Ramanujan's first formula for an ellipse).
    pub fn circumference_m(&self) -> f64 {
        let [a, b, _] = self.semi_axes_m;
        std::f64::consts::PI * (3.0 * (a + b) - ((3.0 * a + b) * (a + 3.0 * b)).sqrt())
    }

    /// The cranium in the head frame.
    pub fn cranium(&self) -> Ellipsoid {
        Ellipsoid { semi_axes: self.semi_axes_m() }
    }

    /// Middle (head frame) and semi-axes of either ear, metres.
    pub fn ears(&self) -> [(Point3<f64>, Vector3<f64>); 2] {
        let [middle, semi_axes] = EAR.map(|share| self.share(share));
        let mirrored = Point3::new(-middle.x, middle.y, middle.z);
        [Point3::from(middle), mirrored].map(|middle| (middle, semi_axes))
    }

    /// Ends of the neck's axis (head frame), upper first, and its radius, metres.
    pub fn neck(&self) -> ([Point3<f64>; 2], f64) {
        (NECK.map(|share| Point3::from(self.share(share))), NECK_RADIUS * self.semi_axes_m[0])
    }

    fn share(&self, share: [f64; 3]) -> Vector3<f64> {
        Vector3::from(share).component_mul(&self.semi_axes_m())
    }
}

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

    /// Cranium, ears and neck in world.
    pub(crate) fn bodies(&self, friction: f64) -> Vec<Body> {
        let ([top, bottom], radius) = self.size.neck();
        let axis = bottom - top;
        // The shortest turn is undefined for opposite vectors alone; a neck never points up.
        let turn = UnitQuaternion::rotation_between(&-Vector3::z(), &axis).unwrap_or_default();
        let neck = Capsule { half_length: axis.norm() / 2.0, radius };
        let middle = Translation3::from(nalgebra::center(&top, &bottom).coords);
        let body = |shape, placed: Pose, resolution| Body {
            shape,
            pose: self.pose * placed,
            friction,
            resolution,
        };
        let cranium = Shape::Ellipsoid(self.size.cranium());
        let mut bodies = vec![body(cranium, Pose::identity(), Resolution::Vertices)];
        bodies.extend(self.size.ears().map(|(middle, semi_axes)| {
            let placed = Pose::from_parts(middle.into(), UnitQuaternion::identity());
            body(Shape::Ellipsoid(Ellipsoid { semi_axes }), placed, Resolution::Samples)
        }));
        let placed = Pose::from_parts(middle, turn);
        bodies.push(body(Shape::Capsule(neck), placed, Resolution::Vertices));
        bodies
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_their_circumferences() {
        for ((name, size), expected) in HeadSize::NAMED.into_iter().zip([0.535, 0.555, 0.580]) {
            assert!((size.circumference_m() - expected).abs() < 5e-4, "{name}");
        }
        assert!(HeadSize::of_semi_axes([0.0, 0.1, 0.1]).is_none());
        assert!(HeadSize::of_semi_axes([f64::NAN, 0.1, 0.1]).is_none());
        assert_eq!(HeadSize::of_semi_axes(HEAD_SEMI_AXES_M), Some(HeadSize::MEDIUM));
    }

    #[test]
    fn ears_stand_off_below_the_widest_level_and_the_neck_is_under_the_head() {
        for (name, size) in HeadSize::NAMED {
            for (middle, semi_axes) in size.ears() {
                let outermost =
                    Point3::new(middle.x + middle.x.signum() * semi_axes.x, middle.y, middle.z);
                let off = size.cranium().signed_distance(&outermost).0;
                assert!((0.010..0.018).contains(&off), "{name}: an ear stands off by {off} m");
                assert!(middle.z + semi_axes.z < 0.0, "{name}: an ear reaches the hat line");
            }
            let ([top, bottom], radius) = size.neck();
            assert!(size.cranium().contains(&top) && !size.cranium().contains(&bottom));
            assert!(radius < size.semi_axes_m().x);
        }
    }
}
