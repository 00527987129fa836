//! A hook: a wooden peg on a wall.

use super::half_space;
use crate::contact::capsule::Capsule;
use crate::contact::{Body, Probes, Shape};
use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use seeone_core::Pose;

/// Radius of the peg, metres.
pub const PEG_RADIUS_M: f64 = 0.006;
/// Length of the peg from the wall to the middle of its end ball, metres.
pub const PEG_LENGTH_M: f64 = 0.090;
/// Radius of the ball at the peg's end, metres.
pub const PEG_BALL_RADIUS_M: f64 = 0.008;
/// How steeply the peg rises from the wall, radians.
const PEG_RISE_RAD: f64 = 20.0 * std::f64::consts::PI / 180.0;

/// A peg on a wall. Its frame: the origin where the peg leaves the wall, y out of the wall,
/// z up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hook {
    /// Hook frame -> world.
    pub pose: Pose,
}

impl Hook {
    /// Direction of the peg away from the wall, a unit vector in the hook frame.
    pub fn axis() -> Vector3<f64> {
        Vector3::new(0.0, PEG_RISE_RAD.cos(), PEG_RISE_RAD.sin())
    }

    /// The middle of the ball at the peg's end in the hook frame, metres.
    pub fn tip() -> Point3<f64> {
        Point3::from(Self::axis() * PEG_LENGTH_M)
    }

    /// Hook frame -> world of a body along the peg whose middle is `along` metres from the
    /// wall; the body's z axis points along the peg.
    pub fn along_peg(&self, along: f64) -> Pose {
        let turn = UnitQuaternion::from_axis_angle(
            &Vector3::x_axis(),
            PEG_RISE_RAD - std::f64::consts::FRAC_PI_2,
        );
        self.pose * Pose::from_parts(Translation3::from(Self::axis() * along), turn)
    }

    /// The peg and the ball at its end in world.
    pub(crate) fn peg(&self, friction: f64) -> [Body; 2] {
        let half_length = PEG_LENGTH_M / 2.0;
        let body = |half_length, radius, along| Body {
            shape: Shape::Capsule(Capsule { half_length, radius }),
            pose: self.along_peg(along),
            friction,
            probes: Probes::Samples,
        };
        [body(half_length, PEG_RADIUS_M, half_length), body(0.0, PEG_BALL_RADIUS_M, PEG_LENGTH_M)]
    }

    /// The peg and the wall behind it in world.
    pub(crate) fn bodies(&self, friction: f64) -> Vec<Body> {
        let out = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), -std::f64::consts::FRAC_PI_2);
        let wall = half_space(self.pose * out, friction);
        self.peg(friction).into_iter().chain([wall]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peg_rises_from_the_wall() {
        let hook = Hook { pose: Pose::translation(0.1, 0.2, 0.5) };
        let [peg, ball, wall] = hook.bodies(0.3).try_into().expect("three bodies");
        let tip = hook.pose * Hook::tip();
        assert!((ball.distance(&tip) + PEG_BALL_RADIUS_M).abs() < 1e-12);
        assert!((peg.distance(&tip) + PEG_RADIUS_M).abs() < 1e-12);
        assert!((wall.distance(&tip) - PEG_LENGTH_M * PEG_RISE_RAD.cos()).abs() < 1e-12);
        assert!((tip.z - 0.5 - PEG_LENGTH_M * PEG_RISE_RAD.sin()).abs() < 1e-12);
        let foot = hook.pose * Point3::origin();
        assert!(wall.distance(&foot).abs() < 1e-12 && peg.distance(&foot) < 0.0);
    }
}
