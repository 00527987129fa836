//! Which vertices may soon be near which triangles.

use super::grid::Grid;
use super::reach::Reach;
use super::snapshot::Snapshot;
use nalgebra::Point3;
use seeone_core::Pose;

/// For each triangle the vertices that may come within some reach of it before the shell
/// has moved far.
#[derive(Clone, Debug)]
pub struct Near {
    /// How much farther than asked for is looked, metres: the lists hold until something has
    /// moved through half of it.
    margin_m: f64,
    /// Edge of a cell of the search grid, metres: about an edge of the mesh.
    cell_m: f64,
    grid: Grid,
    found_at: Snapshot,
    /// Triangle by triangle, in each as the cells of the grid come.
    vertices: Vec<u32>,
    /// Where each triangle's begin; one entry more than triangles.
    starts: Vec<usize>,
    /// For each vertex the last triangle that it is exempt at: of the many vertices that are
    /// looked at few are exempt, and looking each up among those took longer than finding it.
    exempt_at: Vec<u32>,
}

impl Near {
    /// Empty lists.
    pub fn new(reach: &Reach) -> Self {
        Self {
            margin_m: reach.near_m,
            cell_m: reach.cell_m,
            grid: Grid::default(),
            found_at: Snapshot::default(),
            vertices: Vec::new(),
            starts: Vec::new(),
            exempt_at: Vec::new(),
        }
    }

    /// Brings the lists up to date: after it they hold every vertex within `reach_m` of each
    /// triangle at `position`, but for those that are `exempt` there, in any order. `frame` (shell -> world)
    /// moves about as the whole shell does.
    pub fn update(
        &mut self,
        triangles: &[[u32; 3]],
        exempt: &[Vec<u32>],
        reach_m: f64,
        position: &[Point3<f64>],
        frame: &Pose,
    ) {
        if self.found_at.moved_m(position, frame) <= self.margin_m / 2.0 {
            return;
        }
        let Self { margin_m, cell_m, grid, found_at, vertices, starts, exempt_at } = self;
        found_at.take(position, frame);
        grid.fill(position, *cell_m);
        vertices.clear();
        starts.clear();
        starts.push(0);
        exempt_at.clear();
        exempt_at.resize(position.len(), u32::MAX);
        for (t, (triangle, exempt)) in (0..).zip(triangles.iter().zip(exempt)) {
            exempt.iter().for_each(|v| exempt_at[*v as usize] = t);
            let corners = triangle.map(|v| position[v as usize]);
            grid.for_each_around(&corners, reach_m + *margin_m, |v| {
                if exempt_at[v as usize] != t {
                    vertices.push(v);
                }
            });
            starts.push(vertices.len());
        }
    }

    /// The vertices of triangle `t`.
    pub fn of(&self, t: usize) -> &[u32] {
        &self.vertices[self.starts[t]..self.starts[t + 1]]
    }
}
