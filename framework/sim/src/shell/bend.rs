//! Bending: one dihedral-angle constraint per pair of triangles on an edge.

mod angle;
mod batch;

use super::colouring::by_colour;
use super::lanes::LANES;
use super::stretch::area;
use super::topology::{Edge, opposite};
use crate::object::{Object, Region};
use angle::bent;
use batch::Batch;
use nalgebra::{Point3, Vector3};
use seeone_core::vectorize::vectorize;

/// Rayleigh damping of bending, s: fabric loses a ripple within a few of its periods.
pub const BENDING_DAMPING_S: f64 = 2.0e-3;

#[derive(Clone, Copy, Debug)]
struct Hinge {
    /// The two ends of the edge, then the corner opposite to it on either side.
    corners: [usize; 4],
    /// Sine and cosine of the angle at rest.
    rest: (f64, f64),
    /// The angle at rest, radians; 0 is flat.
    rest_angle: f64,
    stiffness_n_m: f64,
    /// The region of both its triangles, unless it is a seam.
    region: Option<Region>,
}

impl Hinge {
    /// The angle from rest, radians, within half a turn; `None` without an extent.
    fn off(&self, position: &[Point3<f64>]) -> Option<f64> {
        let bent = bent(&self.corners.map(|v| position[v].coords), self.rest);
        (bent.extent > 0.0).then(|| bent.turn.0.atan2(bent.turn.1))
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
    /// The same, as they are solved.
    batches: Vec<Batch>,
    /// Which batches were damped last: those of even numbers (0) or of odd ones (1).
    damped: usize,
}

impl Bend {
    /// Hinges over the `edges` of the object's rest shape, coloured. A seam between two
    /// regions is as soft as the softer of them.
    pub fn new(object: &Object, edges: &[Edge]) -> Self {
        let mesh = object.mesh();
        let mut hinges = Vec::new();
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
                let points = corners.map(|v| mesh.vertices()[v].coords);
                let bending =
                    object.material(one).bending_n_m.min(object.material(other).bending_n_m);
                let regions = [one, other].map(|t| object.regions()[t]);
                let region = Some(regions[0]).filter(|r| *r == regions[1]);
                let areas = area(mesh, one) + area(mesh, other);
                let at_rest = bent(&points, (0.0, 1.0));
                if at_rest.extent > 0.0 {
                    let rest_angle = at_rest.turn.0.atan2(at_rest.turn.1);
                    hinges.push(Hinge {
                        corners,
                        rest: rest_angle.sin_cos(),
                        rest_angle,
                        stiffness_n_m: bending * (points[1] - points[0]).norm_squared() / areas,
                        region,
                    });
                }
            }
        }
        let apart = by_colour(&mut hinges, mesh.vertices().len(), |h| h.corners);
        let batches = apart.into_iter().flat_map(|run| hinges[run].chunks(LANES)).map(Batch::new);
        Self { batches: batches.collect(), hinges, damped: 0 }
    }

    /// One sweep of a substep of `h` seconds. `previous` are the positions at its start.
    pub fn solve(
        &mut self,
        position: &mut [Point3<f64>],
        previous: &[Point3<f64>],
        inverse_mass: &[f64],
        h: f64,
    ) {
        vectorize(
            #[inline(always)]
            || {
                for batch in &mut self.batches {
                    batch.solve(position, previous, inverse_mass, h);
                }
            },
        );
    }

    /// Takes from the velocities what Rayleigh damping of `damping_s` seconds, usually
    /// [`BENDING_DAMPING_S`], does in `h` seconds.
    ///
    /// Not inside the sweep over positions: there it also brakes the way back from what
    /// gravity and the sweep's other constraints have just added, and a shell at rest
    /// hangs lower by a share of about k w beta h (stiffness, inverse mass, damping). The
    /// gradients are those of the last sweep: the substep's small motion since then changes
    /// the damping a little, and working them out anew would cost as much as the sweep. Half
    /// of the hinges are damped in a substep, for two.
    pub fn damp(
        &mut self,
        velocity: &mut [Vector3<f64>],
        inverse_mass: &[f64],
        h: f64,
        damping_s: f64,
    ) {
        self.damped = 1 - self.damped;
        vectorize(
            #[inline(always)]
            || {
                for batch in self.batches.iter().skip(self.damped).step_by(2) {
                    batch.damp(velocity, inverse_mass, 2.0 * h, damping_s);
                }
            },
        );
    }

    /// Takes every hinge to be bent by less than half a turn from rest, and at rest.
    pub fn forget(&mut self) {
        self.batches.iter_mut().for_each(Batch::forget);
        self.damped = 0;
    }

    /// Elastic energy, J.
    pub fn energy(&self, position: &[Point3<f64>]) -> f64 {
        let energy = |h: &Hinge| Some(h.stiffness_n_m * h.off(position)?.powi(2) / 2.0);
        self.hinges.iter().filter_map(energy).sum()
    }

    /// Root mean square angle from rest of the hinges inside `region`, radians; 0 without
    /// any.
    pub fn error(&self, position: &[Point3<f64>], region: Region) -> f64 {
        let inside = self.hinges.iter().filter(|h| h.region == Some(region));
        let off = inside.filter_map(|h| h.off(position));
        let (sum, count) = off.fold((0.0, 0), |(sum, n), off| (sum + off * off, n + 1));
        (sum / f64::from(count.max(1))).sqrt()
    }

    /// The same hinges with `factor` times the stiffness; none at all for a factor of 0.
    #[cfg(test)]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.hinges.iter_mut().for_each(|h| h.stiffness_n_m *= factor);
        self.hinges.retain(|h| h.stiffness_n_m > 0.0);
        self.batches = self.hinges.chunks(1).map(Batch::new).collect();
        self
    }
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
            Bend::new(&object, &super::super::topology::edges(object.mesh().triangles()));
        let mut x = Vec::new();
        for degrees in [90.0, 170.0, 200.0] {
            x = at(degrees);
            bend.solve(&mut x, &at(degrees), &[1e4; 4], 1e-3);
        }
        let before = bend.batches[0].first_off().abs();
        for _ in 0..100 {
            let previous = x.clone();
            bend.solve(&mut x, &previous, &[1e4; 4], 1e-3);
        }
        let after = bend.batches[0].first_off().abs();
        assert!(
            before > 3.0 && after < batch::LARGEST_FOLD_RAD + 0.01,
            "{before} then {after} rad"
        );
    }
}
