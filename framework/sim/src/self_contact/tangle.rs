//! Tangles: where the shell has gone through itself, and how it gets out again.
//!
//! An edge that pierces a triangle is moved so that the line in which the two sheets cut
//! each other gets shorter (Volino and Magnenat-Thalmann 2006). No history is needed:
//! whatever brought the tangle about, the line shrinks to nothing.

use super::grid::Grid;
use super::reach::Reach;
use super::snapshot::Snapshot;
use crate::shell::topology::{self, Edge};
use nalgebra::{Point3, Vector3};
use seeone_core::{Pose, TriangleMesh};

/// How far a pierced pair is moved in a substep, metres.
const STEP_M: f64 = 3.0e-4;
/// Substeps between two searches, while nothing is pierced and while something is.
const CALM_SUBSTEPS: u32 = 40;
const TANGLED_SUBSTEPS: u32 = 4;
/// With more than this share of the vertices moved so far, all is remembered anew; with
/// fewer, what belongs to them is looked up.
const MOVED_SHARE: f64 = 0.25;

/// An edge that pierces a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Piercing {
    pub triangle: u32,
    pub edge: u32,
}

/// An edge with the opposite corners of its triangles.
#[derive(Clone, Copy, Debug)]
struct Winged {
    ends: [u32; 2],
    /// Twice the same on a border.
    wings: [u32; 2],
}

/// Finds tangles now and then, and undoes them.
#[derive(Clone, Debug)]
pub struct Tangle {
    /// Short edges first.
    edges: Vec<Winged>,
    short: usize,
    /// Edges and triangles this near each other are remembered, metres: until one has moved
    /// through half of it no others can pierce.
    margin_m: f64,
    /// Edge of a cell of the search grid, metres.
    cell_m: f64,
    /// The edges in the grid, and where their middles are.
    numbers: Vec<usize>,
    middles: Vec<Point3<f64>>,
    grid: Grid,
    /// What may pierce before something has moved far since `found_at`.
    candidates: Vec<Piercing>,
    found_at: Snapshot,
    /// For each vertex whether it has moved too far since.
    moved: Vec<bool>,
    piercings: Vec<Piercing>,
    /// Substeps until the next search.
    wait: u32,
}

impl Tangle {
    /// Tangles among the triangles of the rest shape `mesh`.
    pub fn new(mesh: &TriangleMesh, reach: &Reach) -> Self {
        let winged = |e: &Edge| {
            let wing = |t: usize| topology::opposite(&mesh.triangles()[t], e.ends) as u32;
            let (first, last) = (e.triangles[0], e.triangles[e.triangles.len() - 1]);
            Winged { ends: e.ends.map(|v| v as u32), wings: [wing(first), wing(last)] }
        };
        let all = topology::edges(mesh.triangles());
        let long = |e: &Edge| {
            (mesh.vertices()[e.ends[0]] - mesh.vertices()[e.ends[1]]).norm() > reach.long_m
        };
        let (long, short): (Vec<_>, Vec<_>) = all.iter().partition(|e| long(e));
        Self {
            short: short.len(),
            margin_m: reach.tangle_m,
            cell_m: reach.cell_m,
            edges: short.into_iter().chain(long).map(winged).collect(),
            numbers: Vec::new(),
            middles: Vec::new(),
            grid: Grid::default(),
            candidates: Vec::new(),
            found_at: Snapshot::default(),
            moved: Vec::new(),
            piercings: Vec::new(),
            wait: 0,
        }
    }

    /// What was pierced when it was last looked for.
    pub fn piercings(&self) -> &[Piercing] {
        &self.piercings
    }

    /// The vertices of all that was pierced or pierces.
    pub fn vertices(&self, triangles: &[[u32; 3]]) -> impl Iterator<Item = u32> {
        self.piercings.iter().flat_map(|p| {
            let edge = self.edges[p.edge as usize];
            triangles[p.triangle as usize].into_iter().chain(edge.ends).chain(edge.wings)
        })
    }

    /// Looks for tangles when it is time to; whether it did. `frame` (shell -> world) moves
    /// about as the whole shell does.
    pub fn look(&mut self, triangles: &[[u32; 3]], position: &[Point3<f64>], frame: &Pose) -> bool {
        if self.wait > 0 {
            self.wait -= 1;
            return false;
        }
        self.search(triangles, position, frame);
        self.wait = if self.piercings.is_empty() { CALM_SUBSTEPS } else { TANGLED_SUBSTEPS };
        true
    }

    /// Every edge that pierces one of `triangles`, ascending.
    pub fn search(&mut self, triangles: &[[u32; 3]], position: &[Point3<f64>], frame: &Pose) {
        let moved = self.found_at.mark_moved(position, frame, self.margin_m / 2.0, &mut self.moved);
        let many = moved as f64 > MOVED_SHARE * position.len() as f64;
        if many {
            self.candidates.clear();
            self.pair(triangles, position, self.margin_m, |_| true, |_| true);
            self.found_at.take(position, frame);
        }
        let known = self.candidates.len();
        if moved > 0 && !many {
            let marks = std::mem::take(&mut self.moved);
            let any = |vertices: &[u32]| vertices.iter().any(|v| marks[*v as usize]);
            self.pair(triangles, position, 0.0, any, |_| true);
            self.pair(triangles, position, 0.0, |corners| !any(corners), any);
            self.moved = marks;
        }
        let Self { edges, candidates, piercings, .. } = self;
        let pierces = |candidate: &&Piercing| {
            let ends = edges[candidate.edge as usize].ends.map(|v| position[v as usize]);
            let corners = triangles[candidate.triangle as usize].map(|v| position[v as usize]);
            !beyond(&ends, &corners, 0.0) && Hit::of(&ends, &corners).is_some()
        };
        piercings.clear();
        piercings.extend(candidates.iter().filter(pierces));
        piercings.sort_unstable();
        piercings.dedup();
        candidates.truncate(known);
    }

    /// Adds to the candidates which edges and triangles are within `margin_m` of each other,
    /// of those whose vertices are wanted.
    fn pair(
        &mut self,
        triangles: &[[u32; 3]],
        position: &[Point3<f64>],
        margin_m: f64,
        of_triangles: impl Fn(&[u32]) -> bool,
        of_edges: impl Fn(&[u32]) -> bool,
    ) {
        let Self { edges, short, cell_m, numbers, middles, grid, candidates, .. } = self;
        let wanted = |range: std::ops::Range<usize>| range.filter(|e| of_edges(&edges[*e].ends));
        let ends = |e: usize| edges[e].ends.map(|v| position[v as usize]);
        middles.clear();
        numbers.clear();
        let mut reach_m = 0.0f64;
        for e in wanted(0..*short) {
            let [a, b] = ends(e);
            middles.push(nalgebra::center(&a, &b));
            numbers.push(e);
            reach_m = reach_m.max((b - a).amax() / 2.0 + margin_m);
        }
        grid.fill(middles, *cell_m);
        let long: Vec<usize> = wanted(*short..edges.len()).collect();
        for (t, triangle) in triangles.iter().enumerate().filter(|(_, t)| of_triangles(&t[..])) {
            let corners = triangle.map(|v| position[v as usize]);
            let mut test = |e: usize| {
                let apart = edges[e].ends.iter().all(|v| !triangle.contains(v));
                if apart && !beyond(&ends(e), &corners, margin_m) {
                    candidates.push(Piercing { triangle: t as u32, edge: e as u32 });
                }
            };
            grid.for_each_around(&corners, reach_m, |n| test(numbers[n as usize]));
            long.iter().for_each(|e| test(*e));
        }
    }

    /// Moves what is pierced apart. Speed comes of it, and must: without, whatever the shell
    /// is hooked into holds against it.
    pub fn undo(&self, triangles: &[[u32; 3]], position: &mut [Point3<f64>], inverse_mass: &[f64]) {
        for piercing in &self.piercings {
            let edge = self.edges[piercing.edge as usize];
            let corner_ids = triangles[piercing.triangle as usize].map(|v| v as usize);
            let end_ids = edge.ends.map(|v| v as usize);
            let corners = corner_ids.map(|v| position[v]);
            let ends = end_ids.map(|v| position[v]);
            let Some(hit) = Hit::of(&ends, &corners) else { continue };
            let wings = edge.wings.map(|v| position[v as usize]);
            let Some(shift) = hit.shortening(&ends, &wings) else { continue };
            let weights = end_ids
                .into_iter()
                .zip(hit.along)
                .chain(corner_ids.into_iter().zip(hit.weights.map(|b| -b)));
            let inverse: f64 = weights.clone().map(|(v, b)| inverse_mass[v] * b * b).sum();
            if inverse <= 0.0 {
                continue;
            }
            for (v, b) in weights {
                let step = shift * (STEP_M * inverse_mass[v] * b / inverse);
                position[v] += step;
            }
        }
    }
}

/// Whether one axis of space shows more than `margin_m` between a segment and a triangle.
fn beyond(ends: &[Point3<f64>; 2], corners: &[Point3<f64>; 3], margin_m: f64) -> bool {
    let [p, q] = ends;
    let [a, b, c] = corners;
    (0..3).any(|k| {
        p[k].max(q[k]) + margin_m < a[k].min(b[k]).min(c[k])
            || p[k].min(q[k]) - margin_m > a[k].max(b[k]).max(c[k])
    })
}

/// Where a segment goes through a triangle.
struct Hit {
    /// Shares of the segment's ends.
    along: [f64; 2],
    /// Barycentric weights in the triangle.
    weights: [f64; 3],
    normal: Vector3<f64>,
}

impl Hit {
    fn of(ends: &[Point3<f64>; 2], corners: &[Point3<f64>; 3]) -> Option<Self> {
        let [p, q] = ends;
        let [a, b, c] = corners;
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(&ac);
        let (before, after) = ((p - a).dot(&normal), (q - a).dot(&normal));
        if before * after >= 0.0 {
            return None;
        }
        let share = before / (before - after);
        let from_a = p + (q - p) * share - a;
        let squared = normal.norm_squared();
        let v = from_a.cross(&ac).dot(&normal) / squared;
        let w = ab.cross(&from_a).dot(&normal) / squared;
        let weights = [1.0 - v - w, v, w];
        let normal = normal / squared.sqrt();
        let inside = weights.iter().all(|b| *b > 0.0);
        inside.then_some(Self { along: [1.0 - share, share], weights, normal })
    }

    /// The direction in which the edge must move against the triangle for the line of
    /// intersection to get shorter: a unit vector. `wings` are the corners of the edge's
    /// triangles opposite to it.
    fn shortening(
        &self,
        ends: &[Point3<f64>; 2],
        wings: &[Point3<f64>; 2],
    ) -> Option<Vector3<f64>> {
        let edge = ends[1] - ends[0];
        let across = edge.dot(&self.normal);
        let both = wings[0] != wings[1];
        let pull = |wing: &Point3<f64>| {
            let face = edge.cross(&(wing - ends[0]));
            let line = face.cross(&self.normal).try_normalize(0.0)?;
            // Into the wing's triangle, away from the edge.
            let inward = face.cross(&edge);
            let line = if line.dot(&inward) < 0.0 { -line } else { line };
            Some(line - self.normal * (2.0 * edge.dot(&line) / across))
        };
        let sum = wings[..1 + usize::from(both)].iter().filter_map(pull).sum::<Vector3<f64>>();
        sum.try_normalize(1e-9)
    }
}
