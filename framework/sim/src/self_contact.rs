//! Contact of a shell with itself: vertices against triangles.
//!
//! Pairs are found with a margin, anew whenever something has moved through half of it;
//! each pair remembers on which side of the triangle its vertex is, so that a vertex
//! pushed through in one substep is brought back in the next.

mod facet;
mod grid;
mod near;
mod reach;
mod recovery;
mod snapshot;
mod tangle;

use facet::Facet;
use grid::Grid;
use nalgebra::{Point3, Vector3};
use near::Near;
use reach::Reach;
use recovery::Recovery;
use seeone_core::{Pose, TriangleMesh};
use snapshot::Snapshot;
use tangle::Tangle;

/// Smallest distance kept between two layers, metres: two half thicknesses of 1.5 mm.
const SEPARATION_M: f64 = 3.0e-3;
/// Speed at which layers that are too near move apart, m/s: slower than a body pushes out
/// what they would be moved into.
const APART_M_S: f64 = 0.1;
/// A pair is given up when its vertex is this deep on the wrong side, metres.
const DEEPEST_M: f64 = 2.0 * SEPARATION_M;
/// What is nearer than this may touch within the next substep, metres.
const NEAR_M: f64 = SEPARATION_M + 1.0e-3;
/// What is this near at rest, or this little outside in barycentric coordinates, is no
/// pair: a seam would push itself open.
const REST_CLEARANCE_M: f64 = 2.0 * SEPARATION_M;
const REST_OVERLAP: f64 = 0.3;
/// What is nearer than this at rest, whatever lies between, is no pair either: the layers of
/// the tightest fold are one thickness apart where the fabric is half a turn of that
/// diameter long.
const FOLD_M: f64 = 0.5 * std::f64::consts::PI * SEPARATION_M;
/// Pairs are sorted by how far they may move before they can touch, in so many rings that are
/// as wide as the margin together.
const RINGS: usize = 12;
/// How far outside a triangle, in barycentric coordinates, a vertex is still above it.
const OVERLAP: f64 = 0.02;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Pair {
    triangle: u32,
    vertex: u32,
    /// +1 on the side that the normal points to, -1 on the other, 0 in a tangle.
    side: f64,
    /// Zero for what may touch now; others may move against each other by one ring less
    /// than this before they can.
    ring: u8,
}

impl Pair {
    fn ring(slack_m: f64, width_m: f64) -> u8 {
        if slack_m > 0.0 { ((slack_m / width_m) as u8).saturating_add(1) } else { 0 }
    }
}

/// The self-contact of one shell.
#[derive(Clone, Debug)]
pub struct SelfContact {
    triangles: Vec<[u32; 3]>,
    /// For each triangle the vertices that never collide with it.
    exempt: Vec<Vec<u32>>,
    reach: Reach,
    near: Near,
    /// Ascending by triangle, then vertex.
    pairs: Vec<Pair>,
    fresh: Vec<Pair>,
    /// Indices of the pairs, ring by ring, ascending in each.
    order: Vec<u32>,
    /// How many of them are in each ring or one before it.
    up_to: [usize; RINGS + 1],
    /// The last ring whose pairs may touch by now.
    awake: usize,
    /// Where the vertices were when the pairs were found.
    found_at: Snapshot,
    tangle: Tangle,
    recovery: Recovery,
    /// For each vertex whether it is about a tangle.
    tangled: Vec<bool>,
}

impl SelfContact {
    /// Contact among the triangles of the rest shape `mesh`.
    pub fn new(mesh: &TriangleMesh) -> Self {
        let mut grid = Grid::default();
        grid.fill(mesh.vertices(), REST_CLEARANCE_M);
        let exempt = |index: usize| {
            let corners = mesh.corners(index);
            let mut near = mesh.triangles()[index].to_vec();
            grid.for_each_around(&corners, REST_CLEARANCE_M, |vertex| {
                let at_rest = Facet::new(&corners).map(|facet| {
                    let above = facet.above(&mesh.vertices()[vertex as usize]);
                    (facet, above)
                });
                if at_rest.is_none_or(|(facet, above)| {
                    above.is_over(REST_OVERLAP) && above.height.abs() < REST_CLEARANCE_M
                        || facet.distance(&above) < FOLD_M
                }) {
                    near.push(vertex);
                }
            });
            near
        };
        let reach = Reach::of(mesh);
        Self {
            triangles: mesh.triangles().to_vec(),
            exempt: (0..mesh.triangles().len()).map(exempt).collect(),
            reach,
            near: Near::new(&reach),
            pairs: Vec::new(),
            fresh: Vec::new(),
            order: Vec::new(),
            up_to: [0; RINGS + 1],
            awake: 0,
            found_at: Snapshot::default(),
            tangle: Tangle::new(mesh, &reach),
            recovery: Recovery::new(mesh.vertices()),
            tangled: Vec::new(),
        }
    }

    /// Keeps the layers apart in a substep of `h` seconds that began at `previous`. The pushes conserve
    /// momentum.
    /// `frame` (shell -> world) moves about as the whole does, so that the search for pairs
    /// need not follow.
    pub fn solve(
        &mut self,
        frame: &Pose,
        position: &mut [Point3<f64>],
        previous: &mut [Point3<f64>],
        inverse_mass: &[f64],
        h: f64,
    ) {
        let moved_m = self.found_at.moved_m(position, frame);
        if moved_m > self.reach.pairs_m / 2.0 {
            self.find(position, frame);
        } else {
            self.wake(position, 2.0 * moved_m);
        }
        if self.tangle.look(&self.triangles, position, frame) {
            self.set_sides(position);
        }
        self.tangle.undo(&self.triangles, position, inverse_mass);
        if !self.tangle.piercings().is_empty() {
            self.recovery.draw(position, inverse_mass, h);
        }
        self.push(position, previous, inverse_mass, h);
    }

    fn find(&mut self, position: &[Point3<f64>], frame: &Pose) {
        self.found_at.take(position, frame);
        let margin_m = self.reach.pairs_m;
        let reach_m = SEPARATION_M + margin_m;
        self.near.update(&self.triangles, &self.exempt, reach_m, position, frame);
        self.fresh.clear();
        let ring_m = self.ring_m();
        let Self { triangles, near, pairs, fresh, .. } = self;
        let mut before = pairs.as_slice();
        for (t, triangle) in triangles.iter().enumerate() {
            let corners = triangle.map(|v| position[v as usize]);
            let Some(facet) = Facet::new(&corners) else { continue };
            let passed = before.iter().take_while(|p| (p.triangle as usize) < t).count();
            before = &before[passed..];
            let [a, b, c] = &corners;
            let reach = Vector3::repeat(reach_m);
            let (low, high) = (a.inf(b).inf(c) - reach, a.sup(b).sup(c) + reach);
            let first = fresh.len();
            for vertex in near.of(t) {
                let point = &position[*vertex as usize];
                // Without a branch an axis: which of them fails cannot be predicted.
                if !(0..3).fold(true, |all, k| all & (low[k] <= point[k]) & (point[k] <= high[k])) {
                    continue;
                }
                let above = facet.above(point);
                if above.height.abs() > reach_m {
                    continue;
                }
                let mut of_this = before.iter().take_while(|p| p.triangle as usize == t);
                let known = of_this.find(|p| p.vertex == *vertex);
                let side = match known {
                    Some(pair) if above.is_over(OVERLAP) => pair.side,
                    _ => above.height.signum(),
                };
                let behind = above.height * side <= 0.0;
                let slack_m = if behind { 0.0 } else { facet.distance(&above) - NEAR_M };
                if slack_m < margin_m {
                    let ring = Pair::ring(slack_m, ring_m);
                    fresh.push(Pair { triangle: t as u32, vertex: *vertex, side, ring });
                }
            }
            fresh[first..].sort_unstable_by_key(|p| p.vertex);
        }
        std::mem::swap(&mut self.pairs, &mut self.fresh);
        self.sort_into_rings();
    }

    /// Width of a ring, metres.
    fn ring_m(&self) -> f64 {
        self.reach.pairs_m / RINGS as f64
    }

    /// A counting sort of the pairs.
    fn sort_into_rings(&mut self) {
        let Self { pairs, order, up_to, .. } = self;
        *up_to = [0; RINGS + 1];
        for pair in pairs.iter() {
            up_to[pair.ring as usize] += 1;
        }
        for ring in 0..RINGS {
            up_to[ring + 1] += up_to[ring];
        }
        let mut ends = *up_to;
        order.clear();
        order.resize(pairs.len(), 0);
        for (index, pair) in pairs.iter().enumerate().rev() {
            let end = &mut ends[pair.ring as usize];
            *end -= 1;
            order[*end] = index as u32;
        }
        self.awake = 0;
    }

    /// Wakes the pairs that may touch after a relative motion of `moved_m` since they were
    /// found. Until then each has been where it may change sides freely.
    fn wake(&mut self, position: &[Point3<f64>], moved_m: f64) {
        let ring_m = self.ring_m();
        let Self { triangles, pairs, order, up_to, awake, .. } = self;
        while *awake < RINGS && *awake as f64 * ring_m <= moved_m {
            *awake += 1;
            for index in &order[up_to[*awake - 1]..up_to[*awake]] {
                let pair = &mut pairs[*index as usize];
                let corners = triangles[pair.triangle as usize].map(|v| position[v as usize]);
                if let Some(facet) = Facet::new(&corners) {
                    pair.side = facet.above(&position[pair.vertex as usize]).height.signum();
                }
            }
        }
    }

    /// Takes the memory of its side from whatever is about a tangle: something there is on
    /// the wrong side, and nothing tells what. What is free again remembers where it is.
    fn set_sides(&mut self, position: &[Point3<f64>]) {
        let Self { triangles, pairs, tangle, recovery, tangled, .. } = self;
        tangled.clear();
        tangled.resize(position.len(), false);
        tangle.vertices(triangles).for_each(|v| tangled[v as usize] = true);
        if tangle.piercings().is_empty() {
            recovery.end();
        } else {
            recovery.widen(triangles, tangled);
        }
        for pair in pairs {
            let triangle = triangles[pair.triangle as usize];
            let about = |v: &u32| tangled[*v as usize];
            if about(&pair.vertex) && triangle.iter().any(about) {
                pair.side = 0.0;
            } else if pair.side == 0.0 {
                let corners = triangle.map(|v| position[v as usize]);
                let height = |f: Facet| f.above(&position[pair.vertex as usize]).height;
                pair.side = Facet::new(&corners).map_or(0.0, |f| height(f).signum());
            }
        }
    }

    /// Every edge that now pierces a triangle, counted.
    pub fn crossings(&self, position: &[Point3<f64>]) -> usize {
        let mut tangle = self.tangle.clone();
        tangle.search(&self.triangles, position, &Pose::identity());
        tangle.piercings().len()
    }

    /// Stops what comes too near, and moves apart what is: the former takes the speed with
    /// which it came, the latter must not add any, so it moves the substep's start as well.
    fn push(
        &mut self,
        position: &mut [Point3<f64>],
        previous: &mut [Point3<f64>],
        inverse_mass: &[f64],
        h: f64,
    ) {
        for index in &self.order[..self.up_to[self.awake]] {
            let pair = &mut self.pairs[*index as usize];
            let ids = self.triangles[pair.triangle as usize].map(|v| v as usize);
            let corners = ids.map(|v| position[v]);
            let vertex = pair.vertex as usize;
            let Some(facet) = Facet::new(&corners) else { continue };
            let above = facet.above(&position[vertex]);
            if !above.is_over(OVERLAP) {
                // Beside the triangle a vertex may change sides: it goes round it.
                pair.side = above.height.signum();
                continue;
            }
            let gap = above.height * pair.side;
            if !(-DEEPEST_M..SEPARATION_M).contains(&gap) {
                continue;
            }
            let inverse: f64 = inverse_mass[vertex]
                + ids.iter().zip(above.weights).map(|(v, b)| inverse_mass[*v] * b * b).sum::<f64>();
            if inverse <= 0.0 {
                continue;
            }
            let moved = |v: usize| position[v] - previous[v];
            let under: Vector3<f64> =
                ids.iter().zip(above.weights).map(|(v, b)| moved(*v) * b).sum();
            let came = (under - moved(vertex)).dot(&above.normal) * pair.side;
            let missing = SEPARATION_M - gap;
            let stop = came.clamp(0.0, missing);
            let apart = (missing - stop).min(APART_M_S * h);
            let direction = above.normal * (pair.side / inverse);
            let weights = [(vertex, 1.0)].into_iter();
            for (v, b) in weights.chain(ids.into_iter().zip(above.weights.map(|b| -b))) {
                let share = direction * (inverse_mass[v] * b);
                position[v] += share * (stop + apart);
                previous[v] += share * apart;
            }
        }
    }
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
        let mesh = TriangleMesh::new(points.clone(), vec![[0, 1, 2]]).expect("a mesh");
        let mut contact = SelfContact {
            exempt: vec![vec![0, 1, 2]],
            pairs: vec![Pair { triangle: 0, vertex: 3, side: 1.0, ring: 0 }],
            order: vec![0],
            up_to: [1; RINGS + 1],
            ..SelfContact::new(&mesh)
        };
        for _ in 0..100 {
            let mut previous = points.clone();
            contact.solve(&Pose::identity(), &mut points, &mut previous, &[1.0; 4], 1e-3);
            let gained = previous.iter().zip(&points).map(|(q, p)| (p - q).norm());
            assert!(gained.fold(0.0, f64::max) < 1e-15, "it gains no speed");
        }
        let corners = [points[0], points[1], points[2]];
        let height = Facet::new(&corners).expect("a triangle").above(&points[3]).height;
        assert!((height - SEPARATION_M).abs() < 1e-6, "{height}");
        let centre: Vector3<f64> = points.iter().map(|p| p.coords).sum();
        assert!((centre - Vector3::new(0.025, 0.025, -0.001)).norm() < 1e-12);
    }
}
