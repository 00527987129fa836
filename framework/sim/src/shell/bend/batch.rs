//! Hinges solved side by side.

#![expect(clippy::needless_range_loop, reason = "a lane is an index into many arrays at once")]

use super::Hinge;
use super::angle::{Bent, bent, is_small, small_angle};
use crate::shell::lanes::{self, LANES, Lanes, Vectors, each, from_lane, into_lane};
use nalgebra::{Point3, Vector3};
use std::f64::consts::{PI, TAU};

/// Two triangles of some 12 mm and of fabric with a thickness fold no farther, radians.
pub const LARGEST_FOLD_RAD: f64 = 2.9;
/// How far what is folded farther opens in a substep, radians: faster, it would pop.
const UNFOLD_RAD: f64 = 0.02;

/// Hinges that share no vertex.
#[derive(Clone, Debug)]
pub struct Batch {
    corners: lanes::Batch<4>,
    rest_angle: Lanes,
    /// Sine and cosine of it.
    rest: [Lanes; 2],
    stiffness_n_m: Lanes,
    /// The last angles from rest, radians: beyond half a turn when folded through itself.
    off: Lanes,
    /// The angles' gradients when they were last solved.
    gradient: Vectors<4>,
}

impl Batch {
    /// One to [`LANES`] hinges.
    pub fn new(hinges: &[Hinge]) -> Self {
        Self {
            corners: lanes::Batch::new(hinges, |h| h.corners),
            rest_angle: each(hinges, |h| h.rest_angle),
            rest: [each(hinges, |h| h.rest.0), each(hinges, |h| h.rest.1)],
            stiffness_n_m: each(hinges, |h| h.stiffness_n_m),
            off: [0.0; LANES],
            gradient: lanes::vectors(),
        }
    }

    /// One sweep of a substep of `h` seconds. `previous` are the positions at its start.
    #[inline(always)]
    pub fn solve(
        &mut self,
        position: &mut [Point3<f64>],
        previous: &[Point3<f64>],
        inverse_mass: &[f64],
        h: f64,
    ) {
        let points = self.corners.gather(|v| position[v].coords);
        let masses = self.corners.masses(inverse_mass);
        let mut turn = [[0.0; LANES]; 2];
        let mut angle = [0.0; LANES];
        for l in 0..LANES {
            let rest = (self.rest[0][l], self.rest[1][l]);
            let Bent { turn: (sin, cos), gradient, extent } = bent(&from_lane(&points, l), rest);
            // Without an extent there is no angle, and no reason to move.
            let some = extent > 0.0;
            let gradient = gradient.map(|g| g.map(|c| if some { c } else { 0.0 }));
            into_lane(&mut self.gradient, l, &gradient);
            (turn[0][l], turn[1][l]) = if some { (sin, cos) } else { (0.0, 1.0) };
            angle[l] = small_angle((turn[0][l], turn[1][l]));
        }
        for l in 0..LANES {
            let turn = (turn[0][l], turn[1][l]);
            self.follow(l, if is_small(turn) { angle[l] } else { turn.0.atan2(turn.1) });
        }
        let mut lambda = [0.0; LANES];
        for l in 0..LANES {
            let weight = weight(&from_lane(&self.gradient, l), &masses, l);
            lambda[l] = -self.off[l] / (weight + 1.0 / (self.stiffness_n_m[l] * h * h));
        }
        for l in 0..LANES {
            if (self.rest_angle[l] + self.off[l]).abs() >= LARGEST_FOLD_RAD {
                let start = self.corners.vertices(l).map(|v| previous[v].coords);
                lambda[l] = self.unfold(&from_lane(&points, l), &start, &masses, l);
            }
        }
        self.corners.apply(position, &self.gradient, &masses, &lambda);
    }

    /// The impulse that opens a hinge which is folded too far: as fast as it is closing in this
    /// substep, and a little more.
    fn unfold(
        &self,
        points: &[Vector3<f64>; 4],
        start: &[Vector3<f64>; 4],
        masses: &[Lanes; 4],
        l: usize,
    ) -> f64 {
        let gradient = from_lane(&self.gradient, l);
        let fold = self.rest_angle[l] + self.off[l];
        let moved = points.iter().zip(start).zip(&gradient).map(|((p, s), g)| g.dot(&(p - s)));
        let side = fold.signum();
        let most = (moved.sum::<f64>() * side).max(0.0) + UNFOLD_RAD;
        let weight = weight(&gradient, masses, l);
        let back = (fold.abs() - LARGEST_FOLD_RAD).min(most);
        if weight > 0.0 { -side * back / weight } else { 0.0 }
    }

    /// Takes from the velocities what Rayleigh damping of `damping_s` seconds does in `h`
    /// seconds.
    #[inline(always)]
    pub fn damp(
        &self,
        velocity: &mut [Vector3<f64>],
        inverse_mass: &[f64],
        h: f64,
        damping_s: f64,
    ) {
        let velocities = self.corners.gather(|v| velocity[v]);
        let masses = self.corners.masses(inverse_mass);
        let mut impulse = [0.0; LANES];
        for l in 0..LANES {
            let (gradient, velocity) = (from_lane(&self.gradient, l), from_lane(&velocities, l));
            let [a, b, c, d] = [0, 1, 2, 3].map(|k| gradient[k].dot(&velocity[k]));
            let strength = self.stiffness_n_m[l] * damping_s * h;
            let weight = weight(&gradient, &masses, l);
            impulse[l] = -strength * (a + b + c + d) / (1.0 + strength * weight);
        }
        self.corners.apply(velocity, &self.gradient, &masses, &impulse);
    }

    /// Takes every hinge to be bent by less than half a turn from rest, and at rest.
    pub fn forget(&mut self) {
        self.off = [0.0; LANES];
        self.gradient = lanes::vectors();
    }

    /// Remembers the angle from rest that is `off` but for whole turns and nearest to the
    /// last one: a hinge that folds through itself must come back the way it went.
    #[inline(always)]
    fn follow(&mut self, lane: usize, off: f64) {
        let last = self.off[lane];
        self.off[lane] =
            if (last - off).abs() < PI { off } else { off + ((last - off) / TAU).round() * TAU };
    }

    /// The last angle from rest of the first hinge, radians.
    #[cfg(test)]
    pub fn first_off(&self) -> f64 {
        self.off[0]
    }
}

/// How far an impulse on an angle moves it: the inverse masses, weighed by `gradient`.
#[inline(always)]
fn weight(gradient: &[Vector3<f64>; 4], masses: &[Lanes; 4], l: usize) -> f64 {
    let [a, b, c, d] = [0, 1, 2, 3].map(|k| masses[k][l] * gradient[k].dot(&gradient[k]));
    a + b + c + d
}
