//! Contact of a shell with rigid bodies, with Coulomb friction.
//!
//! A contact lifts a point out of the body along the normal by dn and then takes back at
//! most mu dn of its tangential motion relative to the body (position-level Coulomb
//! friction; Macklin et al. 2014).

mod bodies;
mod body;
pub mod capsule;
pub mod ellipsoid;
pub mod pads;
mod resolve;
mod sample;

pub use bodies::Bodies;
pub use body::{Body, Probes, Shape};
pub use sample::Sample;

use nalgebra::{Matrix3, Vector3};

/// Speed at which a body pushes out what it was put into, m/s: shoved out at once, a cap
/// placed a millimetre inside the head would leave it at the speed limit.
const PUSH_OUT_M_S: f64 = 0.3;

/// Where a point touches a body.
#[derive(Clone, Copy, Debug)]
pub struct Touch {
    /// Outward unit normal of the body.
    pub normal: Vector3<f64>,
    /// How deep the point is inside, metres, positive.
    pub depth: f64,
    /// How the body moved there within the substep, metres.
    pub carried: Vector3<f64>,
}

impl Touch {
    /// The correction of a point that moved by `moved` in this substep of `h` seconds, and
    /// its normal part.
    #[inline]
    pub fn correction(&self, moved: &Vector3<f64>, friction: f64, h: f64) -> (Vector3<f64>, f64) {
        let relative = moved - self.carried;
        let lift = self.lift(&relative, h);
        let tangential = relative - self.normal * relative.dot(&self.normal);
        let slide = tangential.norm();
        let grip = if slide > friction * lift { friction * lift / slide } else { 1.0 };
        (self.normal * lift - tangential * grip, lift)
    }

    /// The impulse on a rigid part that yields by `yielding` (1/kg) at a point that moved by
    /// `moved` in this substep of `h` seconds: the lift, and at most `friction` times as
    /// much against the slide. Times `h`, hence in kg m.
    pub fn impulse(
        &self,
        moved: &Vector3<f64>,
        yielding: &Matrix3<f64>,
        friction: f64,
        h: f64,
    ) -> Vector3<f64> {
        let relative = moved - self.carried;
        let yields = |along: &Vector3<f64>| along.dot(&(yielding * along));
        let press = self.lift(&relative, h) / yields(&self.normal);
        let lifted = relative + yielding * self.normal * press;
        let slide = lifted - self.normal * lifted.dot(&self.normal);
        let lift = self.normal * press;
        match slide.try_normalize(0.0) {
            None => lift,
            Some(along) => lift - along * (slide.norm() / yields(&along)).min(friction * press),
        }
    }

    /// How far a point that moved by `relative` to the body comes out in this substep of
    /// `h` seconds, metres.
    #[inline]
    pub fn lift(&self, relative: &Vector3<f64>, h: f64) -> f64 {
        let approach = (-relative.dot(&self.normal)).max(0.0);
        self.depth.min(approach + PUSH_OUT_M_S * h)
    }
}
