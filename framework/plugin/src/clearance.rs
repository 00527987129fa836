//! What the arm is near to at a posture, for the solvers that keep away from it.

use nalgebra::{Point3, Unit, Vector3};
use std::fmt;

/// Two bodies that are nearer than they may be.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Their names: URDF links, obstacles, `table`, or `held`.
    pub bodies: [String; 2],
    /// Their distance, metres; negative when they overlap by so much. Of bodies whose flat
    /// faces overlap only that they do is known: zero.
    pub distance_m: f64,
    /// The distance that they should keep, metres.
    pub wanted_m: f64,
}

impl fmt::Display for Contact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [body, other] = &self.bodies;
        let short = 1e3 * (self.wanted_m - self.distance_m);
        write!(f, "{body} is {short:.1} mm too near to {other}")
    }
}

/// Two bodies that are near each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proximity {
    /// Their distance beyond what they should keep, metres.
    pub margin_m: f64,
    /// The direction in `world` from the first to the second.
    pub normal: Unit<Vector3<f64>>,
    /// The arm link that carries each, and the point in `world` where it is nearest to the
    /// other; `None` for what stands still.
    pub carriers: [Option<(usize, Point3<f64>)>; 2],
}

/// Distances of the arm from itself and from what surrounds it.
pub trait Clearance: Sync {
    /// A pair that is too near at joint positions `q`, if there is one.
    fn contact(&self, q: &[f64]) -> Option<Contact>;

    /// Puts every pair with a margin below `within_m` at `q` into `found`, the nearest first.
    fn proximities(&self, q: &[f64], within_m: f64, found: &mut Vec<Proximity>);
}
