//! Contact of a shell with rigid bodies, with Coulomb friction.
//!
//! A contact lifts a point out of the body along the normal by dn and then takes back at
//! most mu dn of its tangential motion relative to the body (position-level Coulomb
//! friction; Macklin et al. 2014).

pub mod ellipsoid;
pub mod pads;
mod sample;

pub use sample::Sample;

use crate::shell::{Momentum, Shell};
use ellipsoid::Ellipsoid;
use nalgebra::Vector3;
use seeone_core::Pose;

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
        let approach = (-relative.dot(&self.normal)).max(0.0);
        let lift = self.depth.min(approach + PUSH_OUT_M_S * h);
        let tangential = relative - self.normal * relative.dot(&self.normal);
        let slide = tangential.norm();
        let grip = if slide > friction * lift { friction * lift / slide } else { 1.0 };
        (self.normal * lift - tangential * grip, lift)
    }
}

/// The table's top: the plane z = 0. Adds what it gave the shell to `given`.
pub fn with_table(shell: &mut Shell, friction: f64, h: f64, given: &mut Momentum) {
    for vertex in 0..shell.position.len() {
        let depth = -shell.position[vertex].z;
        if depth > 0.0 {
            let touch = Touch { normal: Vector3::z(), depth, carried: Vector3::zeros() };
            resolve(shell, vertex, &touch, friction, h, given);
        }
    }
}

/// An ellipsoid at rest at `pose`. Adds what it gave the shell to `given`.
pub fn with_ellipsoid(
    shell: &mut Shell,
    body: &Ellipsoid,
    pose: &Pose,
    friction: f64,
    h: f64,
    given: &mut Momentum,
) {
    for vertex in 0..shell.position.len() {
        let local = pose.inverse_transform_point(&shell.position[vertex]);
        if !body.contains(&local) {
            continue;
        }
        let (distance, normal) = body.signed_distance(&local);
        let normal = pose.rotation * normal;
        let touch = Touch { normal, depth: -distance, carried: Vector3::zeros() };
        resolve(shell, vertex, &touch, friction, h, given);
    }
}

#[inline]
fn resolve(
    shell: &mut Shell,
    vertex: usize,
    touch: &Touch,
    friction: f64,
    h: f64,
    given: &mut Momentum,
) {
    if shell.inverse_mass[vertex] <= 0.0 {
        return;
    }
    let moved = shell.position[vertex] - shell.previous[vertex];
    let (correction, _) = touch.correction(&moved, friction, h);
    shell.position[vertex] += correction;
    given.add(&(correction * (shell.mass[vertex] / h)), &shell.position[vertex]);
}
