//! Tangles: where the shell has gone through itself, and how it gets out again.
//!
//! An edge that pierces a triangle is moved so that the line in which the two sheets cut
//! each other gets shorter (Volino and Magnenat-Thalmann 2006). No history is needed:
//! whatever brought the tangle about, the line shrinks to nothing.

use super::grid::Grid;
use crate::shell::topology::{self, Edge};
use nalgebra::{Point3, Vector3};
use seeone_core::TriangleMesh;

/// How far a pierced pair is moved in a substep, metres.
const STEP_M: f64 = 3.0e-4;
/// Substeps between two searches, while nothing is pierced and while something is.
const CALM_SUBSTEPS: u32 = 40;
const TANGLED_SUBSTEPS: u32 = 4;
/// Edges longer than this are compared with every triangle, metres: the grid serves the
/// many short ones.
const LONG_M: f64 = 0.02;

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
    middles: Vec<Point3<f64>>,
    grid: Grid,
    piercings: Vec<Piercing>,
    /// Substeps until the next search.
    wait: u32,
}

impl Tangle {
    /// Tangles among the triangles of the rest shape `mesh`.
    pub fn new(mesh: &TriangleMesh) -> Self {
        let winged = |e: &Edge| {
            let wing = |t: usize| topology::opposite(&mesh.triangles()[t], e.ends) as u32;
            let (first, last) = (e.triangles[0], e.triangles[e.triangles.len() - 1]);
            Winged { ends: e.ends.map(|v| v as u32), wings: [wing(first), wing(last)] }
        };
        let all = topology::edges(mesh.triangles());
        let long =
            |e: &Edge| (mesh.vertices()[e.ends[0]] - mesh.vertices()[e.ends[1]]).norm() > LONG_M;
        let (long, short): (Vec<_>, Vec<_>) = all.iter().partition(|e| long(e));
        Self {
            short: short.len(),
            edges: short.into_iter().chain(long).map(winged).collect(),
            middles: Vec::new(),
            grid: Grid::default(),
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

    /// Looks for tangles when it is time to; whether it did.
    pub fn look(&mut self, triangles: &[[u32; 3]], position: &[Point3<f64>]) -> bool {
        if self.wait > 0 {
            self.wait -= 1;
            return false;
        }
        self.find(triangles, position);
        self.wait = if self.piercings.is_empty() { CALM_SUBSTEPS } else { TANGLED_SUBSTEPS };
        true
    }

    /// Every edge that pierces one of `triangles`, ascending.
    pub fn find(&mut self, triangles: &[[u32; 3]], position: &[Point3<f64>]) {
        let Self { edges, short, middles, grid, piercings, .. } = self;
        let ends = |e: usize| edges[e].ends.map(|v| position[v as usize]);
        middles.clear();
        middles.extend((0..*short).map(ends).map(|[a, b]| nalgebra::center(&a, &b)));
        grid.fill(middles, LONG_M / 2.0);
        piercings.clear();
        for (t, triangle) in triangles.iter().enumerate() {
            let corners = triangle.map(|v| position[v as usize]);
            let mut test = |e: usize| {
                let apart = edges[e].ends.iter().all(|v| !triangle.contains(v));
                if apart && pierces(&ends(e), &corners) {
                    piercings.push(Piercing { triangle: t as u32, edge: e as u32 });
                }
            };
            grid.for_each_around(&corners, LONG_M / 2.0, |e| test(e as usize));
            (*short..edges.len()).for_each(&mut test);
        }
        piercings.sort_unstable();
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

/// Whether the segment between `ends` goes through the inside of the triangle `corners`.
fn pierces(ends: &[Point3<f64>; 2], corners: &[Point3<f64>; 3]) -> bool {
    let [p, q] = ends;
    let [a, b, c] = corners;
    let beyond = |k: usize| {
        p[k].max(q[k]) < a[k].min(b[k]).min(c[k]) || p[k].min(q[k]) > a[k].max(b[k]).max(c[k])
    };
    !(0..3).any(beyond) && Hit::of(ends, corners).is_some()
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
