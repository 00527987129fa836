//! A hook: a wooden peg on a wall.

use super::half_space;
use crate::contact::capsule::Capsule;
use crate::contact::{Body, Probes, Shape};
use nalgebra::{Point3, UnitQuaternion, Vector3};
use seeone_core::hook::{PEG_BALL_RADIUS_M, PEG_RADIUS_M};
use seeone_core::{Peg, Pose};

/// A peg on a wall. Its frame: the origin where the peg leaves the wall, y out of the wall,
/// z up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hook {
    /// Hook frame -> world.
    pub pose: Pose,
    /// The peg.
    pub peg: Peg,
}

impl Hook {
    /// A coat hook at `pose` (hook frame -> world).
    pub fn coat(pose: Pose) -> Self {
        Self { pose, peg: Peg::COAT }
    }

    /// The middle of the ball at the peg's end in world, metres.
    pub fn tip(&self) -> Point3<f64> {
        self.pose * self.peg.tip()
    }

    /// The peg and the ball at its end in world.
    pub(crate) fn peg(&self, friction: f64) -> [Body; 2] {
        let length_m = self.peg.length_m();
        let body = |half_length, radius, along| Body {
            shape: Shape::Capsule(Capsule { half_length, radius }),
            pose: self.pose * Peg::along(along),
            friction,
            probes: Probes::Samples,
        };
        let half_length = length_m / 2.0;
        [body(half_length, PEG_RADIUS_M, half_length), body(0.0, PEG_BALL_RADIUS_M, length_m)]
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
        let hook = Hook::coat(Pose::translation(0.1, 0.2, 0.5));
        let [peg, ball, wall] = hook.bodies(0.3).try_into().expect("three bodies");
        let (tip, length_m) = (hook.tip(), hook.peg.length_m());
        assert!((ball.distance(&tip) + PEG_BALL_RADIUS_M).abs() < 1e-12);
        assert!((peg.distance(&tip) + PEG_RADIUS_M).abs() < 1e-12);
        assert!((wall.distance(&tip) - length_m * Peg::axis().y).abs() < 1e-12);
        assert!((tip.z - 0.5 - length_m * Peg::axis().z).abs() < 1e-12);
        let foot = hook.pose * Point3::origin();
        assert!(wall.distance(&foot).abs() < 1e-12 && peg.distance(&foot) < 0.0);
    }
}
