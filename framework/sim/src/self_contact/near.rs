//! Which vertices may soon be near which triangles.

use super::grid::Grid;
use super::snapshot::Snapshot;
use nalgebra::Point3;
use seeone_core::Pose;

/// How much farther than asked for is looked, metres: the lists hold until something has
/// moved through half of it.
const MARGIN_M: f64 = 0.012;
/// Edge of a cell of the search grid, metres: about an edge of the mesh.
const CELL_M: f64 = 0.01;

/// For each triangle the vertices that may come within some reach of it before the shell
/// has moved far.
#[derive(Clone, Debug, Default)]
pub struct Near {
    grid: Grid,
    found_at: Snapshot,
    /// Triangle by triangle, ascending in each.
    vertices: Vec<u32>,
    /// Where each triangle's begin; one entry more than triangles.
    starts: Vec<usize>,
}

impl Near {
    /// Brings the lists up to date: after it they hold every vertex within `reach_m` of each
    /// triangle at `position`, but for those that are `exempt` there. `frame` (shell -> world)
    /// moves about as the whole shell does.
    pub fn update(
        &mut self,
        triangles: &[[u32; 3]],
        exempt: &[Vec<u32>],
        reach_m: f64,
        position: &[Point3<f64>],
        frame: &Pose,
    ) {
        if self.found_at.moved_m(position, frame) <= MARGIN_M / 2.0 {
            return;
        }
        let Self { grid, found_at, vertices, starts } = self;
        found_at.take(position, frame);
        grid.fill(position, CELL_M);
        vertices.clear();
        starts.clear();
        starts.push(0);
        for (triangle, exempt) in triangles.iter().zip(exempt) {
            let corners = triangle.map(|v| position[v as usize]);
            let first = vertices.len();
            grid.for_each_around(&corners, reach_m + MARGIN_M, |v| {
                if !exempt.contains(&v) {
                    vertices.push(v);
                }
            });
            vertices[first..].sort_unstable();
            starts.push(vertices.len());
        }
    }

    /// The vertices of triangle `t`.
    pub fn of(&self, t: usize) -> &[u32] {
        &self.vertices[self.starts[t]..self.starts[t + 1]]
    }
}
