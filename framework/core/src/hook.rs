//! How large a hook is: what scenes name, planners avoid and simulations collide with.
//!
//! A hook is a wooden peg on a wall. Its frame: the origin where the peg leaves the wall, y
//! out of the wall, z up.

use crate::Pose;
use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};

/// Radius of a peg, metres.
pub const PEG_RADIUS_M: f64 = 0.006;
/// Radius of the ball at its end, metres.
pub const PEG_BALL_RADIUS_M: f64 = 0.008;
/// Length of the shortest and of the longest peg, from the wall to the middle of its end
/// ball, metres: from a coat hook's to a hat peg's.
pub const PEG_LENGTH_M: [f64; 2] = [0.06, 0.16];
/// How steeply a peg rises from the wall, radians.
const PEG_RISE_RAD: f64 = 20.0 * std::f64::consts::PI / 180.0;

/// A peg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peg {
    length_m: f64,
}

impl Peg {
    /// A coat hook's, 90 mm long.
    pub const COAT: Self = Self { length_m: 0.090 };

    /// A peg of this length in metres; `None` when no peg has it.
    pub fn of_length(length_m: f64) -> Option<Self> {
        let [low, high] = PEG_LENGTH_M;
        (low..=high).contains(&length_m).then_some(Self { length_m })
    }

    /// From the wall to the middle of its end ball, metres.
    pub fn length_m(&self) -> f64 {
        self.length_m
    }

    /// Direction of every peg away from the wall, a unit vector in the hook frame.
    pub fn axis() -> Vector3<f64> {
        Vector3::new(0.0, PEG_RISE_RAD.cos(), PEG_RISE_RAD.sin())
    }

    /// The middle of the ball at its end in the hook frame, metres.
    pub fn tip(&self) -> Point3<f64> {
        Point3::from(Self::axis() * self.length_m)
    }

    /// The frame of a body along the peg whose middle is `along` metres from the wall, in the
    /// hook frame; the body's z axis points along the peg.
    pub fn along(along: f64) -> Pose {
        let turn = UnitQuaternion::from_axis_angle(
            &Vector3::x_axis(),
            PEG_RISE_RAD - std::f64::consts::FRAC_PI_2,
        );
        Pose::from_parts(Translation3::from(Self::axis() * along), turn)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peg_rises_from_the_wall_along_its_bodies() {
        let peg = Peg::of_length(0.12).expect("a peg's length");
        assert!((peg.tip().coords.norm() - 0.12).abs() < 1e-12 && peg.tip().z > 0.04);
        let end = Peg::along(0.1) * Point3::new(0.0, 0.0, 0.02);
        assert!((end - peg.tip()).norm() < 1e-12);
        assert_eq!(Peg::of_length(Peg::COAT.length_m()), Some(Peg::COAT));
        assert_eq!((Peg::of_length(0.5), Peg::of_length(f64::NAN)), (None, None));
    }
}
