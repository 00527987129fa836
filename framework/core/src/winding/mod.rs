//! The generalised winding number of a triangle mesh (Jacobson et al. 2013): by how much
//! of the full sphere of directions the surface surrounds a point.
//!
//! One inside a closed mesh and zero outside; between the two near the opening of an open
//! one, which is why it serves as the occupancy of a cap (paper, Eq. 4).
//!
//! The usual exact way adds up the solid angles of all triangles. Here an open surface is
//! closed instead, by a curtain that hangs from infinity above on the surface's boundary.
//! Around a point `p` the closed whole winds a whole number of times, namely as often as
//! the ray from `p` straight up leaves through the surface, so
//!
//! `w(p) = crossings above p - (1 / 2 pi) sum over boundary edges (a, b) of arg z_ab(p)`,
//!
//! where `2 arg z_ab` is the solid angle of the curtain's strip above the edge. A cap has
//! thousands of triangles and a hundred boundary edges, a column of points shares its
//! crossings, and the angles are added by multiplying the `z_ab`: no tree, no tolerance.
//!
//! Points exactly on the surface have no winding number; they get a finite value.

mod boundary;
mod crossings;
#[cfg(test)]
mod tests;

use crate::TriangleMesh;
use boundary::{Boundary, Curtain};
use crossings::Row;
use nalgebra::Point3;

/// Points of a column that are computed side by side.
const LANES: usize = 16;

/// The winding number of one mesh about any point, to rounding (some 1e-13).
///
/// The mesh may be open, of several pieces, and of any topology: edges where three sheets
/// meet count as boundary with what the sheets leave over.
#[derive(Clone, Debug)]
pub struct Exact<'a> {
    mesh: &'a TriangleMesh,
    boundary: Boundary,
}

impl<'a> Exact<'a> {
    /// Finds the boundary of `mesh`: the edges along which its triangles do not cancel.
    pub fn new(mesh: &'a TriangleMesh) -> Self {
        Self { mesh, boundary: Boundary::of(mesh) }
    }

    /// The winding number about `point` (same frame and unit as the mesh): positive inside
    /// where triangles run counter-clockwise seen from outside.
    pub fn at(&self, point: &Point3<f64>) -> f64 {
        let crossings = Row::new(self.mesh, point.y).column(point.x);
        let mut curtain = Curtain::new(&self.boundary);
        curtain.place([point.x, point.y]);
        let [angle] = curtain.turns([point.z]);
        crossings.above(point.z) - angle
    }

    /// The winding numbers about the points `low + step * (i, j, k)` with `(i, j, k)` below
    /// `counts`, in the mesh's frame and unit; `k`, the place along z, runs fastest.
    pub fn grid(&self, low: &Point3<f64>, step: f64, counts: [usize; 3]) -> Vec<f64> {
        let [nx, ny, nz] = counts;
        let at = |axis: usize, i: usize| low[axis] + step * i as f64;
        let rows: Vec<Row> = (0..ny).map(|j| Row::new(self.mesh, at(1, j))).collect();
        let mut curtain = Curtain::new(&self.boundary);
        let mut winding = Vec::with_capacity(nx * ny * nz);
        for (i, j) in (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j))) {
            let crossings = rows[j].column(at(0, i));
            curtain.place([at(0, i), at(1, j)]);
            for first in (0..nz).step_by(LANES) {
                let z: [f64; LANES] = std::array::from_fn(|lane| at(2, first + lane));
                let angles = curtain.turns(z);
                let both = z.iter().zip(angles).take(nz - first);
                winding.extend(both.map(|(z, angle)| crossings.above(*z) - angle));
            }
        }
        winding
    }
}

/// Twice the signed area of the triangle origin, `a`, `b`: exactly opposite for `b`, `a`.
fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}
