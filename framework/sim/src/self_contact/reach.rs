//! How far beyond what touches is looked for what may touch soon.

use seeone_core::TriangleMesh;

/// Meshes of edges this long or longer are looked through with the full margins, metres.
const EDGE_M: f64 = 0.010;

/// Margins of the searches, metres. Each holds until something has moved through half of it.
///
/// On a mesh of shorter edges they shrink: else a margin would hold as many more of a triangle's
/// neighbours as the edges are shorter, squared, and the time would grow faster than the
/// vertices. What is looked through often shrinks by that square, what is seldom found anew by
/// the edge alone.
#[derive(Clone, Copy, Debug)]
pub struct Reach {
    /// Beyond the separation, for pairs of a vertex and a triangle.
    pub pairs_m: f64,
    /// Beyond that, for lists of what may become a pair.
    pub near_m: f64,
    /// Between an edge and a triangle that may pierce each other.
    pub tangle_m: f64,
    /// Edge of a cell of the search grids.
    pub cell_m: f64,
    /// Edges longer than this are compared with every triangle: a grid serves the many short
    /// ones, and is searched as far as half of the longest of them.
    pub long_m: f64,
}

impl Reach {
    /// The reach for a shell whose rest shape is `mesh`.
    pub fn of(mesh: &TriangleMesh) -> Self {
        let scale = (mean_edge_m(mesh) / EDGE_M).min(1.0);
        Self {
            pairs_m: 3.0e-3 * scale.powi(2),
            near_m: 0.012 * scale,
            tangle_m: 4.0e-3 * scale.powi(2),
            cell_m: 0.010 * scale,
            long_m: 0.020 * scale,
        }
    }
}

/// Mean length of the triangles' sides.
fn mean_edge_m(mesh: &TriangleMesh) -> f64 {
    let count = mesh.triangles().len().max(1) as f64;
    let around = |t| {
        let [a, b, c] = mesh.corners(t);
        (b - a).norm() + (c - b).norm() + (a - c).norm()
    };
    (0..mesh.triangles().len()).map(around).sum::<f64>() / (3.0 * count)
}
