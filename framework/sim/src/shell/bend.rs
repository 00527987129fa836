//! Bending: one dihedral-angle constraint per pair of triangles on an edge.

use super::colouring::by_colour;
use super::stretch::area;
use super::topology::{Edge, opposite};
use crate::object::{Object, Region};
use nalgebra::{Point3, Vector3};
use std::f64::consts::{PI, TAU};

/// Rayleigh damping of bending, s: fabric loses a ripple within a few of its periods.
pub const BENDING_DAMPING_S: f64 = 2.0e-3;

/// Two triangles of some 12 mm and of fabric with a thickness fold no farther, radians.
const LARGEST_FOLD_RAD: f64 = 2.9;
/// How far what is folded farther opens in a substep, radians: faster, it would pop.
const UNFOLD_RAD: f64 = 0.02;

#[derive(Clone, Copy, Debug)]
struct Hinge {
    /// The two ends of the edge, then the corner opposite to it on either side.
    corners: [usize; 4],
    /// Sine and cosine of the angle at rest.
    rest: (f64, f64),
    /// The angle at rest, radians; 0 is flat.
    rest_angle: f64,
    /// The last angle from rest, radians: beyond half a turn when folded through itself.
    off: f64,
    stiffness_n_m: f64,
    /// The region of both its triangles, unless it is a seam.
    region: Option<Region>,
    /// The angle's gradient when it was last solved.
    gradient: [Vector3<f64>; 4],
}

impl Hinge {
    /// How far an impulse on the angle moves it: the inverse masses, weighed by `gradient`.
    #[inline(always)]
    fn weight(&self, gradient: &[Vector3<f64>; 4], inverse_mass: &[f64]) -> f64 {
        let pairs = gradient.iter().zip(&self.corners);
        pairs.map(|(g, v)| inverse_mass[*v] * g.norm_squared()).sum()
    }

    /// The angle from rest that is `off` but for whole turns and nearest to the last one: a
    /// hinge that folds through itself must come back the way it went.
    fn follow(&mut self, off: f64) -> f64 {
        self.off = if (self.off - off).abs() < PI {
            off
        } else {
            off + ((self.off - off) / TAU).round() * TAU
        };
        self.off
    }
}

/// Every hinge of a shell as an XPBD constraint on its angle (Macklin et al. 2016), with
/// Rayleigh damping of its velocity.
///
/// The energy of a hinge is k (theta - theta0)^2 / 2 with k = B l^2 / (A1 + A2), which
/// averages to B kappa^2 / 2 per area over equilateral triangles; the often quoted
/// factor of three is three times too stiff.
#[derive(Clone, Debug)]
pub struct Bend {
    hinges: Vec<Hinge>,
    /// Those inside a rigid part, which keeps their angles without them.
    idle: Vec<Hinge>,
}

impl Bend {
    /// Hinges over the `edges` of the object's rest shape, coloured. A seam between two
    /// regions is as soft as the softer of them. `rigid` tells whether vertices belong to
    /// one rigid part.
    pub fn new(object: &Object, edges: &[Edge], rigid: &dyn Fn(&[usize]) -> bool) -> Self {
        let mesh = object.mesh();
        let (mut hinges, mut idle) = (Vec::new(), Vec::new());
        for edge in edges {
            for pair in edge.triangles.windows(2) {
                let [one, other] = [pair[0], pair[1]];
                let triangles = mesh.triangles();
                let corners = [
                    edge.ends[0],
                    edge.ends[1],
                    opposite(&triangles[one], edge.ends),
                    opposite(&triangles[other], edge.ends),
                ];
                let points = corners.map(|v| mesh.vertices()[v]);
                let bending =
                    object.material(one).bending_n_m.min(object.material(other).bending_n_m);
                let regions = [one, other].map(|t| object.regions()[t]);
                let region = Some(regions[0]).filter(|r| *r == regions[1]);
                let areas = area(mesh, one) + area(mesh, other);
                if let Some(Bent { off: rest_angle, .. }) = bent(&points, (0.0, 1.0)) {
                    let rest = rest_angle.sin_cos();
                    let stiffness_n_m = bending * (points[1] - points[0]).norm_squared() / areas;
                    let of = if rigid(&corners) { &mut idle } else { &mut hinges };
                    of.push(Hinge {
                        corners,
                        rest,
                        rest_angle,
                        off: 0.0,
                        stiffness_n_m,
                        region,
                        gradient: [Vector3::zeros(); 4],
                    });
                }
            }
        }
        by_colour(&mut hinges, mesh.vertices().len(), |h| h.corners);
        Self { hinges, idle }
    }

    /// One sweep of a substep of `h` seconds. `previous` are the positions at its start.
    pub fn solve(
        &mut self,
        position: &mut [Point3<f64>],
        previous: &[Point3<f64>],
        inverse_mass: &[f64],
        h: f64,
    ) {
        for hinge in &mut self.hinges {
            let points = hinge.corners.map(|v| position[v]);
            let Some(Bent { off, gradient }) = bent(&points, hinge.rest) else { continue };
            hinge.gradient = gradient;
            let off = hinge.follow(off);
            let weight = hinge.weight(&gradient, inverse_mass);
            if weight <= 0.0 {
                continue;
            }
            let fold = hinge.rest_angle + off;
            let lambda = if fold.abs() < LARGEST_FOLD_RAD {
                -off / (weight + 1.0 / (hinge.stiffness_n_m * h * h))
            } else {
                let side = fold.signum();
                let moved = hinge.corners.iter().zip(&gradient).zip(&points);
                let turned: f64 = moved.map(|((v, g), p)| g.dot(&(p - previous[*v]))).sum();
                let most = (turned * side).max(0.0) + UNFOLD_RAD;
                -side * (fold.abs() - LARGEST_FOLD_RAD).min(most) / weight
            };
            for (k, v) in hinge.corners.iter().enumerate() {
                position[*v] += gradient[k] * (inverse_mass[*v] * lambda);
            }
        }
    }

    /// Takes from the velocities what Rayleigh damping of `damping_s` seconds, usually
    /// [`BENDING_DAMPING_S`], does in `h` seconds.
    ///
    /// Not inside the sweep over positions: there it also brakes the way back from what
    /// gravity and the sweep's other constraints have just added, and a shell at rest
    /// hangs lower by a share of about k w beta h (stiffness, inverse mass, damping). The
    /// gradients are those of the last sweep: the substep's small motion since then changes
    /// the damping a little, and working them out anew would cost as much as the sweep.
    pub fn damp(
        &self,
        velocity: &mut [Vector3<f64>],
        inverse_mass: &[f64],
        h: f64,
        damping_s: f64,
    ) {
        for hinge in &self.hinges {
            let gradient = &hinge.gradient;
            let pairs = gradient.iter().zip(&hinge.corners);
            let rate: f64 = pairs.map(|(g, v)| g.dot(&velocity[*v])).sum();
            let strength = hinge.stiffness_n_m * damping_s * h;
            let weight = hinge.weight(gradient, inverse_mass);
            let impulse = -strength * rate / (1.0 + strength * weight);
            for (k, v) in hinge.corners.iter().enumerate() {
                velocity[*v] += gradient[k] * (inverse_mass[*v] * impulse);
            }
        }
    }

    /// Takes every hinge to be bent by less than half a turn from rest, and at rest.
    pub fn forget(&mut self) {
        for hinge in &mut self.hinges {
            hinge.off = 0.0;
            hinge.gradient = [Vector3::zeros(); 4];
        }
    }

    /// Elastic energy, J.
    pub fn energy(&self, position: &[Point3<f64>]) -> f64 {
        let energy = |h: &Hinge| {
            let bent = bent(&h.corners.map(|v| position[v]), h.rest);
            bent.map_or(0.0, |b| h.stiffness_n_m * b.off.powi(2) / 2.0)
        };
        self.all().map(energy).sum()
    }

    /// Root mean square angle from rest of the hinges inside `region`, radians; 0 without
    /// any.
    pub fn error(&self, position: &[Point3<f64>], region: Region) -> f64 {
        let inside = self.all().filter(|h| h.region == Some(region));
        let bent = inside.filter_map(|h| bent(&h.corners.map(|v| position[v]), h.rest));
        let (sum, count) = bent.fold((0.0, 0), |(sum, n), b| (sum + b.off * b.off, n + 1));
        (sum / f64::from(count.max(1))).sqrt()
    }

    fn all(&self) -> impl Iterator<Item = &Hinge> {
        self.hinges.iter().chain(&self.idle)
    }

    /// The same hinges with `factor` times the stiffness; none at all for a factor of 0.
    #[cfg(test)]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.hinges.iter_mut().for_each(|h| h.stiffness_n_m *= factor);
        self.hinges.retain(|h| h.stiffness_n_m > 0.0);
        self
    }
}

/// A bent hinge: its angle from rest in radians, within half a turn, and the gradient of
/// the angle at its four corners.
struct Bent {
    off: f64,
    gradient: [Vector3<f64>; 4],
}

/// The signed dihedral angle over the edge `[0]`-`[1]` with the opposite corners `[2]` and
/// `[3]`, from the angle whose (sine, cosine) is `rest`; 0 is flat (Bergou et al. 2006).
/// `None` when a triangle or the edge has no extent.
#[inline(always)]
fn bent(points: &[Point3<f64>; 4], rest: (f64, f64)) -> Option<Bent> {
    let [a, b, c, d] = points;
    let edge = b - a;
    let (ac, ad) = (c - a, d - a);
    let normal_c = edge.cross(&ac);
    let normal_d = ad.cross(&edge);
    let (cc, dd, ee) = (normal_c.norm_squared(), normal_d.norm_squared(), edge.norm_squared());
    if cc <= 0.0 || dd <= 0.0 || ee <= 0.0 {
        return None;
    }
    let length = ee.sqrt();
    // Sine and cosine times the lengths of both normals; turning them back by the rest
    // angle leaves a small angle that needs no wrapping.
    let (sin, cos) = (-length * normal_c.dot(&ad), normal_c.dot(&normal_d));
    let off = arc_tangent(sin * rest.1 - cos * rest.0, cos * rest.1 + sin * rest.0);
    let at_c = normal_c * (-length / cc);
    let at_d = normal_d * (-length / dd);
    // The foot of each opposite corner on the edge shares its pull between the ends.
    let per_square = 1.0 / ee;
    let (along_c, along_d) = (ac.dot(&edge) * per_square, ad.dot(&edge) * per_square);
    let at_b = -(at_c * along_c + at_d * along_d);
    let at_a = -(at_c + at_d + at_b);
    Some(Bent { off, gradient: [at_a, at_b, at_c, at_d] })
}

/// atan2 with a short series where the angle is small, as it nearly always is: the
/// library's function would be a fifth of the whole simulation.
#[inline(always)]
fn arc_tangent(sin: f64, cos: f64) -> f64 {
    if sin.abs() >= 0.125 * cos {
        return sin.atan2(cos);
    }
    let x = sin / cos;
    let q = x * x;
    // The first term left out is below 1e-17 of the angle.
    const SERIES: [f64; 9] = [
        1.0,
        -1.0 / 3.0,
        1.0 / 5.0,
        -1.0 / 7.0,
        1.0 / 9.0,
        -1.0 / 11.0,
        1.0 / 13.0,
        -1.0 / 15.0,
        1.0 / 17.0,
    ];
    x * SERIES.iter().rev().fold(0.0, |sum, c| sum * q + c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::object::Material;
    use seeone_core::TriangleMesh;

    /// Two triangles folded by 200 degrees, coming from less than 180, open again; without
    /// the memory they would close through 160 the other way round.
    #[test]
    fn what_has_folded_through_itself_comes_back_the_way_it_went() {
        let wing = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            Point3::new(0.005, -0.01 * cos, -0.01 * sin)
        };
        let at = |degrees| {
            vec![
                Point3::origin(),
                Point3::new(0.01, 0.0, 0.0),
                Point3::new(0.005, 0.01, 0.0),
                wing(degrees),
            ]
        };
        let mesh = TriangleMesh::new(at(0.0), vec![[0, 1, 2], [1, 0, 3]]).expect("a mesh");
        let cloth = Material { density_kg_m2: 0.3, bending_n_m: 1e-4, thickness_m: 0.001 };
        let object = Object::new("pair", "pair", mesh, vec![Region::Crown; 2], [cloth; 4], 0.0)
            .expect("an object");
        let mut bend =
            Bend::new(&object, &super::super::topology::edges(object.mesh().triangles()), &|_| {
                false
            });
        let mut x = Vec::new();
        for degrees in [90.0, 170.0, 200.0] {
            x = at(degrees);
            bend.solve(&mut x, &at(degrees), &[1e4; 4], 1e-3);
        }
        let before = bend.hinges[0].off.abs();
        for _ in 0..100 {
            let previous = x.clone();
            bend.solve(&mut x, &previous, &[1e4; 4], 1e-3);
        }
        let after = bend.hinges[0].off.abs();
        assert!(before > 3.0 && after < LARGEST_FOLD_RAD + 0.01, "{before} then {after} rad");
    }

    #[test]
    fn the_gradient_agrees_with_finite_differences() {
        let points = [
            Point3::new(0.0, 0.1, 0.0),
            Point3::new(1.0, 0.0, 0.2),
            Point3::new(0.3, 0.9, 0.1),
            Point3::new(0.6, -0.8, 0.4),
        ];
        let flat = (0.0, 1.0);
        let gradient = bent(&points, flat).expect("proper triangles").gradient;
        let step = 1e-6;
        for corner in 0..4 {
            for axis in 0..3 {
                let at = |offset: f64| {
                    let mut moved = points;
                    moved[corner][axis] += offset;
                    bent(&moved, flat).expect("proper triangles").off
                };
                let slope = (at(step) - at(-step)) / (2.0 * step);
                assert!((slope - gradient[corner][axis]).abs() < 1e-8, "{corner} {axis}");
            }
        }
    }

    #[test]
    fn the_series_is_the_arc_tangent() {
        for angle in [-3.1, -1.0, -0.1249, -1e-9, 0.0, 0.06, 0.1243, 0.1245, 2.0f64] {
            let (sin, cos) = angle.sin_cos();
            let found = arc_tangent(1e-5 * sin, 1e-5 * cos);
            assert!((found - angle).abs() <= 1e-13 * angle.abs(), "{found} for {angle}");
        }
    }
}
