//! Contact of a shell with itself: vertices against triangles.
//!
//! Pairs are found with a margin, anew whenever something has moved through half of it;
//! each pair remembers on which side of the triangle its vertex is, so that a vertex
//! pushed through in one substep is brought back in the next.

mod grid;
mod tangle;

use grid::Grid;
use nalgebra::{Point3, Vector3};
use seeone_core::TriangleMesh;
use tangle::Tangle;

/// Smallest distance kept between two layers, metres: two half thicknesses of 1.5 mm.
const SEPARATION_M: f64 = 3.0e-3;
/// Largest push in one substep, as a share of the separation: a faster one pops.
const PUSH_SHARE: f64 = 0.1;
/// Pairs are found this much beyond the separation, metres.
const MARGIN_M: f64 = 5.0e-3;
/// Pairs are found within this distance, metres.
const REACH_M: f64 = SEPARATION_M + MARGIN_M;
/// Edge of a cell of the search grid, metres: about an edge of the mesh.
const GRID_CELL_M: f64 = 0.02;
/// What is this near at rest, or this little outside in barycentric coordinates, is no
/// pair: a seam would push itself open.
const REST_CLEARANCE_M: f64 = 2.0 * SEPARATION_M;
const REST_OVERLAP: f64 = 0.3;
/// How far outside a triangle, in barycentric coordinates, a vertex is still above it.
const OVERLAP: f64 = 0.02;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Pair {
    triangle: u32,
    vertex: u32,
    /// +1 on the side that the normal points to, -1 on the other, 0 in a tangle.
    side: f64,
}

impl Pair {
    fn key(&self) -> (u32, u32) {
        (self.triangle, self.vertex)
    }
}

/// The self-contact of one shell.
#[derive(Clone, Debug)]
pub struct SelfContact {
    triangles: Vec<[u32; 3]>,
    /// For each triangle, ascending, the vertices that never collide with it.
    exempt: Vec<Vec<u32>>,
    grid: Grid,
    /// Ascending by triangle, then vertex.
    pairs: Vec<Pair>,
    fresh: Vec<Pair>,
    /// Where the vertices were when the pairs were found; empty before the first time.
    found_at: Vec<Point3<f64>>,
    tangle: Tangle,
}

/// Where a vertex is above a triangle.
struct Above {
    weights: [f64; 3],
    normal: Vector3<f64>,
    height: f64,
}

impl Above {
    /// Whether the foot is inside the triangle, or outside by no more than `overlap`.
    fn is_over(&self, overlap: f64) -> bool {
        self.weights.iter().all(|w| *w >= -overlap)
    }
}

impl SelfContact {
    /// Contact among the triangles of the rest shape `mesh`.
    pub fn new(mesh: &TriangleMesh) -> Self {
        let mut grid = Grid::default();
        grid.fill(mesh.vertices(), GRID_CELL_M);
        let exempt = |index: usize| {
            let corners = mesh.corners(index);
            let mut near = mesh.triangles()[index].to_vec();
            grid.for_each_around(&corners, REACH_M, |vertex| {
                let at_rest = above(&mesh.vertices()[vertex as usize], &corners);
                if at_rest
                    .is_none_or(|a| a.is_over(REST_OVERLAP) && a.height.abs() < REST_CLEARANCE_M)
                {
                    near.push(vertex);
                }
            });
            near.sort_unstable();
            near
        };
        Self {
            triangles: mesh.triangles().to_vec(),
            exempt: (0..mesh.triangles().len()).map(exempt).collect(),
            grid,
            pairs: Vec::new(),
            fresh: Vec::new(),
            found_at: Vec::new(),
            tangle: Tangle::new(mesh),
        }
    }

    /// Keeps the layers apart in one substep. The pushes conserve momentum.
    pub fn solve(
        &mut self,
        position: &mut [Point3<f64>],
        previous: &mut [Point3<f64>],
        velocity: &[Vector3<f64>],
        inverse_mass: &[f64],
        h: f64,
    ) {
        if self.is_stale(position) {
            self.find(position);
        }
        if self.tangle.look(&self.triangles, position) {
            self.set_sides(position);
        }
        self.tangle.undo(&self.triangles, position, previous, inverse_mass);
        self.push(position, velocity, inverse_mass, h);
    }

    /// Whether a pair may have come near since the pairs were found. Motion that all
    /// vertices share does not count.
    fn is_stale(&self, position: &[Point3<f64>]) -> bool {
        let moved = || position.iter().zip(&self.found_at).map(|(now, then)| now - then);
        let mean = moved().sum::<Vector3<f64>>() / position.len() as f64;
        let limit = (MARGIN_M / 2.0) * (MARGIN_M / 2.0);
        self.found_at.len() != position.len() || moved().any(|m| (m - mean).norm_squared() > limit)
    }

    fn find(&mut self, position: &[Point3<f64>]) {
        self.found_at.clear();
        self.found_at.extend_from_slice(position);
        self.grid.fill(position, GRID_CELL_M);
        self.fresh.clear();
        let Self { triangles, exempt, grid, pairs, fresh, .. } = self;
        for (t, triangle) in triangles.iter().enumerate() {
            let corners = triangle.map(|v| position[v as usize]);
            grid.for_each_around(&corners, REACH_M, |vertex| {
                if exempt[t].binary_search(&vertex).is_ok() {
                    return;
                }
                let Some(above) = above(&position[vertex as usize], &corners) else { return };
                if above.height.abs() > REACH_M {
                    return;
                }
                let key = (t as u32, vertex);
                let known = pairs.binary_search_by_key(&key, Pair::key);
                let side = match known {
                    Ok(index) if above.is_over(OVERLAP) => pairs[index].side,
                    _ => above.height.signum(),
                };
                fresh.push(Pair { triangle: t as u32, vertex, side });
            });
        }
        fresh.sort_unstable_by_key(Pair::key);
        std::mem::swap(pairs, fresh);
    }

    /// Takes the memory of its side from whatever is pierced: one end of a piercing edge is
    /// on the wrong side, and nothing tells which. What is free again remembers where it is.
    fn set_sides(&mut self, position: &[Point3<f64>]) {
        let find = |pairs: &[Pair], key: (u32, u32)| pairs.binary_search_by_key(&key, Pair::key);
        for pair in self.pairs.iter_mut().filter(|p| p.side == 0.0) {
            let corners = self.triangles[pair.triangle as usize].map(|v| position[v as usize]);
            let above = above(&position[pair.vertex as usize], &corners);
            pair.side = above.map_or(0.0, |a| a.height.signum());
        }
        for piercing in self.tangle.piercings() {
            for vertex in self.tangle.ends(piercing) {
                if let Ok(index) = find(&self.pairs, (piercing.triangle, vertex)) {
                    self.pairs[index].side = 0.0;
                }
            }
        }
    }

    /// Every edge that now pierces a triangle, counted.
    pub fn crossings(&self, position: &[Point3<f64>]) -> usize {
        let mut tangle = self.tangle.clone();
        tangle.find(&self.triangles, position);
        tangle.piercings().len()
    }

    fn push(
        &mut self,
        position: &mut [Point3<f64>],
        velocity: &[Vector3<f64>],
        inverse_mass: &[f64],
        h: f64,
    ) {
        for pair in &mut self.pairs {
            let ids = self.triangles[pair.triangle as usize].map(|v| v as usize);
            let corners = ids.map(|v| position[v]);
            let vertex = pair.vertex as usize;
            let Some(above) = above(&position[vertex], &corners) else { continue };
            if !above.is_over(OVERLAP) {
                // Beside the triangle a vertex may change sides: it goes round it.
                pair.side = above.height.signum();
                continue;
            }
            let gap = above.height * pair.side;
            if !(-REACH_M..SEPARATION_M).contains(&gap) {
                continue;
            }
            let inverse: f64 = inverse_mass[vertex]
                + ids.iter().zip(above.weights).map(|(v, b)| inverse_mass[*v] * b * b).sum::<f64>();
            if inverse <= 0.0 {
                continue;
            }
            let under: Vector3<f64> =
                ids.iter().zip(above.weights).map(|(v, b)| velocity[*v] * b).sum();
            let approach = (under - velocity[vertex]).dot(&above.normal) * pair.side * h;
            let most = approach.max(0.0) + PUSH_SHARE * SEPARATION_M;
            let push = (SEPARATION_M - gap).min(most) * pair.side / inverse;
            position[vertex] += above.normal * (push * inverse_mass[vertex]);
            for (v, b) in ids.into_iter().zip(above.weights) {
                position[v] -= above.normal * (push * inverse_mass[v] * b);
            }
        }
    }
}

/// Barycentric weights of the foot of `p` on the plane of `corners`, the unit normal and
/// the signed height; `None` for a triangle without area.
#[inline]
fn above(p: &Point3<f64>, corners: &[Point3<f64>; 3]) -> Option<Above> {
    let [a, b, c] = corners;
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let normal = ab.cross(&ac);
    let squared = normal.norm_squared();
    if squared <= 0.0 {
        return None;
    }
    let v = ap.cross(&ac).dot(&normal) / squared;
    let w = ab.cross(&ap).dot(&normal) / squared;
    let length = squared.sqrt();
    Some(Above {
        weights: [1.0 - v - w, v, w],
        normal: normal / length,
        height: ap.dot(&normal) / length,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vertex_that_passed_through_is_brought_back_to_its_side() {
        let mut points = vec![
            Point3::new(0.0, 0.0, 0.0),
            Point3::new(0.02, 0.0, 0.0),
            Point3::new(0.0, 0.02, 0.0),
            Point3::new(0.005, 0.005, -0.001),
        ];
        let mut contact = SelfContact {
            triangles: vec![[0, 1, 2]],
            exempt: vec![vec![0, 1, 2]],
            grid: Grid::default(),
            pairs: vec![Pair { triangle: 0, vertex: 3, side: 1.0 }],
            fresh: Vec::new(),
            found_at: points.clone(),
            tangle: Tangle::new(
                &TriangleMesh::new(points.clone(), vec![[0, 1, 2]]).expect("a mesh"),
            ),
        };
        for _ in 0..100 {
            let mut previous = points.clone();
            contact.solve(&mut points, &mut previous, &[Vector3::zeros(); 4], &[1.0; 4], 1e-3);
        }
        let corners = [points[0], points[1], points[2]];
        let height = above(&points[3], &corners).expect("a triangle").height;
        assert!((height - SEPARATION_M).abs() < 1e-6, "{height}");
        let centre: Vector3<f64> = points.iter().map(|p| p.coords).sum();
        assert!((centre - Vector3::new(0.025, 0.025, -0.001)).norm() < 1e-12);
    }
}
