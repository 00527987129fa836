//! What stays tangled returns to its shape.
//!
//! A line of intersection that ends at a corner of its own triangles, as in a crease that is
//! crumpled about one vertex, does not shrink to nothing. But at rest nothing goes through
//! anything: the patch about the tangle is drawn to the nearest rigid copy of its rest shape, and
//! a wider patch the longer it takes.

use crate::rigid_fit::rigid_fit;
use nalgebra::{Point3, Vector3};

/// How long the line may take to shrink before a patch is drawn, s.
const PATIENCE_S: f64 = 0.25;
/// The patch becomes a ring of triangles wider each time this has passed, s.
const WIDEN_S: f64 = 0.05;
/// Frequency with which a patch returns, Hz.
const RETURN_HZ: f64 = 15.0;
/// No vertex is drawn by more than this in a substep, metres: as far as what is pierced moves.
const STEP_M: f64 = 3.0e-4;

/// Knows how long something has been tangled, and draws the patch about it.
#[derive(Clone, Debug)]
pub struct Recovery {
    rest: Vec<Point3<f64>>,
    /// How long something has been tangled, s.
    tangled_s: f64,
    patch: Vec<usize>,
}

impl Recovery {
    /// Of a shell whose vertices at rest are at `rest`.
    pub fn new(rest: &[Point3<f64>]) -> Self {
        Self { rest: rest.to_vec(), tangled_s: 0.0, patch: Vec::new() }
    }

    /// Nothing is tangled any more.
    pub fn end(&mut self) {
        self.tangled_s = 0.0;
        self.patch.clear();
    }

    /// Widens what is `tangled`, told of each vertex, to the patch that is drawn by now.
    pub fn widen(&mut self, triangles: &[[u32; 3]], tangled: &mut [bool]) {
        self.patch.clear();
        if self.tangled_s < PATIENCE_S {
            return;
        }
        let rings = 1 + ((self.tangled_s - PATIENCE_S) / WIDEN_S) as usize;
        for _ in 0..rings {
            let before = tangled.to_vec();
            for triangle in triangles {
                if triangle.iter().any(|v| before[*v as usize]) {
                    triangle.iter().for_each(|v| tangled[*v as usize] = true);
                }
            }
        }
        self.patch.extend((0..tangled.len()).filter(|v| tangled[*v]));
    }

    /// Draws the patch in a substep of `h` seconds in which something is tangled. It conserves
    /// momentum. A vertex of `inverse_mass` zero stays where it is.
    pub fn draw(&mut self, position: &mut [Point3<f64>], inverse_mass: &[f64], h: f64) {
        self.tangled_s += h;
        self.patch.retain(|v| inverse_mass[*v] > 0.0);
        if self.patch.is_empty() {
            return;
        }
        let Self { rest, patch, .. } = self;
        let from: Vec<_> = patch.iter().map(|v| rest[*v]).collect();
        let to: Vec<_> = patch.iter().map(|v| position[*v]).collect();
        let copy = rigid_fit(&from, &to);
        let mut off: Vec<Vector3<f64>> = from.iter().zip(&to).map(|(r, p)| copy * r - p).collect();
        let mass = |v: &usize| 1.0 / inverse_mass[*v];
        let total: f64 = patch.iter().map(mass).sum();
        let drift = patch.iter().zip(&off).map(|(v, o)| o * mass(v)).sum::<Vector3<f64>>() / total;
        off.iter_mut().for_each(|o| *o -= drift);
        let farthest = off.iter().map(|o| o.norm()).fold(f64::MIN_POSITIVE, f64::max);
        let squared = (std::f64::consts::TAU * RETURN_HZ * h).powi(2);
        let gain = (squared / (1.0 + squared)).min(STEP_M / farthest);
        patch.iter().zip(off).for_each(|(v, o)| position[*v] += o * gain);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const H: f64 = 1.0 / 2400.0;

    /// A strip of twelve vertices at rest, and its triangles.
    fn strip() -> (Vec<Point3<f64>>, Vec<[u32; 3]>) {
        let at = |i: u32| Point3::new(0.01 * f64::from(i / 2), 0.01 * f64::from(i % 2), 0.0);
        ((0..12).map(at).collect(), (0..10).map(|i| [i, i + 1, i + 2]).collect())
    }

    #[test]
    fn a_patch_returns_to_its_shape_without_drifting() {
        let (rest, triangles) = strip();
        let mut now = rest.clone();
        now[5].z += 0.02;
        let inverse_mass: Vec<f64> = (0..12).map(|i| 1e3 * f64::from(1 + i % 3)).collect();
        let centre = |points: &[Point3<f64>]| {
            points.iter().zip(&inverse_mass).map(|(p, w)| p.coords / *w).sum::<Vector3<f64>>()
        };
        let start = centre(&now);
        let mut recovery = Recovery::new(&rest);
        for _ in 0..2400 {
            let mut tangled = vec![false; 12];
            tangled[5] = true;
            recovery.widen(&triangles, &mut tangled);
            recovery.draw(&mut now, &inverse_mass, H);
        }
        assert!((centre(&now) - start).norm() < 1e-12, "it drifts");
        let copy = rigid_fit(&rest, &now);
        let off = rest.iter().zip(&now).map(|(r, p)| (copy * r - p).norm()).fold(0.0, f64::max);
        assert!(off < 2e-3, "{off}");
    }

    #[test]
    fn the_line_is_given_time_and_the_patch_grows() {
        let (rest, triangles) = strip();
        let mut now = rest.clone();
        let mut recovery = Recovery::new(&rest);
        let mut size_after = |seconds: f64| {
            (0..(seconds / H) as usize).for_each(|_| recovery.draw(&mut now, &[1e3; 12], H));
            let mut tangled = vec![false; 12];
            tangled[0] = true;
            recovery.widen(&triangles, &mut tangled);
            let size = tangled.iter().filter(|t| **t).count();
            recovery.end();
            size
        };
        assert_eq!([0.2, 0.26, 0.31].map(&mut size_after), [1, 3, 5]);
    }
}
