//! Objects that were never made: smooth, mirror-symmetric changes of a canonical shape.
//!
//! Ninety training objects leave the corners of the category empty: a brim shorter than
//! any, under a crown lower than any. A frame of such an object is made from a frame of a
//! known one by free-form deformation (Sederberg & Parry 1986): displacements at a lattice
//! of control points over the unit cube, blended by Bernstein polynomials.

use nalgebra::Vector3;
use rand::RngExt;
use seeone_core::random::{Generator, uniform};

/// Control points along x, y and z. Five tell a brim from the crown behind it.
const LATTICE: [usize; 3] = [5, 5, 3];
/// Largest displacement, in canonical units, of a whole layer of control points along its
/// axis (how long is the brim, how high the crown), and of a single point.
const LAYER: f64 = 0.08;
const SINGLE: f64 = 0.03;

/// A change of shape, of centred canonical coordinates.
#[derive(Clone, Debug)]
pub struct Reshape {
    /// Displacements of the control points; x slowest, z fastest.
    controls: Vec<Vector3<f64>>,
    /// What carries the changed object back into the unit cube.
    centre: Vector3<f64>,
    edge: f64,
}

impl Reshape {
    /// A random change of the object with these centred canonical `vertices`.
    pub fn draw(vertices: &[Vector3<f64>], rng: &mut Generator) -> Self {
        // Some objects stay as they are: how far the others change is drawn first.
        let strength = rng.random::<f64>();
        let mut layers = LATTICE.map(|n| vec![0.0; n]);
        for layer in layers.iter_mut().flatten() {
            *layer = strength * uniform(rng, -LAYER, LAYER);
        }
        let [nx, ny, nz] = LATTICE;
        let mut controls = vec![Vector3::zeros(); nx * ny * nz];
        for i in 0..nx.div_ceil(2) {
            for j in 0..ny {
                for k in 0..nz {
                    let layer = Vector3::new(layers[0][i], layers[1][j], layers[2][k]);
                    let single = strength * SINGLE;
                    let own = Vector3::from_fn(|_, _| uniform(rng, -single, single));
                    let mut shift = layer + own;
                    if 2 * i + 1 == nx {
                        shift.x = 0.0; // the mirror plane stays where it is
                    }
                    controls[(i * ny + j) * nz + k] = shift;
                    shift.x = -shift.x;
                    controls[((nx - 1 - i) * ny + j) * nz + k] = shift;
                }
            }
        }
        let mut reshape = Self { controls, centre: Vector3::zeros(), edge: 1.0 };
        let moved = vertices.iter().map(|v| v + reshape.shift(v));
        let (low, high) = moved.fold(
            (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY)),
            |(low, high), p| (low.inf(&p), high.sup(&p)),
        );
        if !vertices.is_empty() {
            reshape.centre = (low + high) / 2.0;
            reshape.edge = (high - low).max();
        }
        reshape
    }

    /// How far a material point of the object moves, before it is canonical again.
    pub fn shift(&self, p: &Vector3<f64>) -> Vector3<f64> {
        let [x, y, z] = [0, 1, 2].map(|axis| p[axis] + 0.5);
        let (wx, wy, wz) = (bernstein::<5>(x), bernstein::<5>(y), bernstein::<3>(z));
        let mut shift = Vector3::zeros();
        let mut control = self.controls.iter();
        for a in wx {
            for b in wy {
                for c in wz {
                    if let Some(control) = control.next() {
                        shift += control * (a * b * c);
                    }
                }
            }
        }
        shift
    }

    /// Where a material point lies in the canonical state of the changed object.
    pub fn canonical(&self, p: &Vector3<f64>) -> Vector3<f64> {
        (p + self.shift(p) - self.centre) / self.edge
    }
}

/// The Bernstein polynomials of degree `N - 1` at `t`, by de Casteljau's recurrence.
fn bernstein<const N: usize>(t: f64) -> [f64; N] {
    let mut weights = [0.0; N];
    weights[0] = 1.0;
    for degree in 1..N {
        for i in (1..=degree).rev() {
            weights[i] = weights[i] * (1.0 - t) + weights[i - 1] * t;
        }
        weights[0] *= 1.0 - t;
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_core::random::generator;

    fn box_of(points: impl Iterator<Item = Vector3<f64>>) -> (Vector3<f64>, Vector3<f64>) {
        points.fold((Vector3::repeat(f64::MAX), Vector3::repeat(f64::MIN)), |(low, high), p| {
            (low.inf(&p), high.sup(&p))
        })
    }

    #[test]
    fn the_changed_object_is_canonical_mirrored_and_another() {
        let mut rng = generator(3, "shape");
        let half: Vec<Vector3<f64>> = (0..300)
            .map(|_| Vector3::from_fn(|_, _| uniform(&mut rng, -0.5, 0.5)))
            .map(|v| v.component_mul(&Vector3::new(0.7, 1.0, 0.5)))
            .collect();
        let (mut farthest, mut shrunk, mut grown) = (0.0f64, 1.0f64, 1.0f64);
        for seed in 0..50 {
            let reshape = Reshape::draw(&half, &mut generator(seed, "reshape"));
            let (low, high) = box_of(half.iter().map(|v| reshape.canonical(v)));
            assert!(((high - low).max() - 1.0).abs() < 1e-12 && (low + high).norm() < 1e-12);
            for v in &half {
                let other = reshape.shift(&Vector3::new(-v.x, v.y, v.z));
                let shift = reshape.shift(v);
                assert!((other - Vector3::new(-shift.x, shift.y, shift.z)).norm() < 1e-12);
                farthest = farthest.max(shift.norm());
            }
            let width = (high - low).x / (high - low).z;
            let before = box_of(half.iter().copied());
            let ratio = width * (before.1 - before.0).z / (before.1 - before.0).x;
            (shrunk, grown) = (shrunk.min(ratio), grown.max(ratio));
        }
        assert!(farthest > 0.05, "hardly moved: {farthest}");
        assert!(shrunk < 0.9 && grown > 1.1, "proportions {shrunk} to {grown}");
    }

    #[test]
    fn nothing_folds_over() {
        let grid = |i: usize| -0.5 + i as f64 / 20.0;
        for seed in 0..100 {
            let reshape = Reshape::draw(&[], &mut generator(seed, "fold"));
            for axis in 0..3 {
                for n in 0..20 * 9 {
                    let mut p = Vector3::from_fn(|a, _| {
                        [-0.4, 0.0, 0.4][(n / 20 / 3usize.pow(a as u32 % 2)) % 3]
                    });
                    p[axis] = grid(n % 20);
                    let mut next = p;
                    next[axis] = grid(n % 20 + 1);
                    let step = next[axis] + reshape.shift(&next)[axis];
                    assert!(step > p[axis] + reshape.shift(&p)[axis], "seed {seed} axis {axis}");
                }
            }
        }
    }
}
