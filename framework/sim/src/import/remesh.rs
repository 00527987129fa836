//! Remeshing to the resolution of the simulation: long edges are split, short ones
//! collapsed, valences evened out and vertices spread (Botsch and Kobbelt 2004), while
//! boundaries and sharp creases stay where they are.

mod collapse;
mod flip;
mod split;

use super::sheet::{Edge, Sheet};
use nalgebra::Vector3;
use std::collections::BTreeSet;

/// Rounds of split, collapse, flip and smooth.
const ROUNDS: usize = 6;
/// Passes of one kind within a round; a pass changes only triangles that do not touch.
const PASSES: usize = 60;
/// Faces that meet at a larger angle form a crease, radians.
const CREASE_RAD: f64 = 0.9;

/// Brings most edges of `sheet` to between 4/5 and 4/3 of `edge_m`.
pub fn remesh(sheet: &mut Sheet, edge_m: f64) {
    let (shortest, longest) = (0.8 * edge_m, edge_m * 4.0 / 3.0);
    for _ in 0..ROUNDS {
        repeat(|| split::pass(sheet, longest));
        repeat(|| collapse::pass(sheet, shortest, longest));
        repeat(|| flip::pass(sheet));
        smooth(sheet);
    }
}

fn repeat(mut pass: impl FnMut() -> usize) {
    for _ in 0..PASSES {
        if pass() == 0 {
            break;
        }
    }
}

/// The edges that must keep their place, and how many of them meet at each vertex.
struct Features {
    edges: BTreeSet<Edge>,
    at_vertex: Vec<usize>,
}

impl Features {
    fn of(sheet: &Sheet) -> Self {
        let edges: BTreeSet<Edge> = sheet
            .edges()
            .into_iter()
            .filter(|(_, faces)| match faces.as_slice() {
                [a, b] => sheet.normal(*a).angle(&sheet.normal(*b)) > CREASE_RAD,
                _ => true,
            })
            .map(|(e, _)| e)
            .collect();
        let mut at_vertex = vec![0; sheet.vertices.len()];
        for (a, b) in &edges {
            at_vertex[*a as usize] += 1;
            at_vertex[*b as usize] += 1;
        }
        Self { edges, at_vertex }
    }

    /// On no feature: free to go anywhere on the surface.
    fn is_free(&self, vertex: u32) -> bool {
        self.at_vertex[vertex as usize] == 0
    }

    /// The end or a branching of features: it stays.
    fn is_corner(&self, vertex: u32) -> bool {
        !matches!(self.at_vertex[vertex as usize], 0 | 2)
    }
}

/// The triangles around every vertex.
fn faces_around(sheet: &Sheet) -> Vec<Vec<usize>> {
    let mut around = vec![Vec::new(); sheet.vertices.len()];
    for (i, t) in sheet.triangles.iter().enumerate() {
        for v in t {
            around[*v as usize].push(i);
        }
    }
    around
}

/// Moves every free vertex half-way to the middle of its neighbours, within the surface.
fn smooth(sheet: &mut Sheet) {
    let features = Features::of(sheet);
    let around = faces_around(sheet);
    let moved = (0u32..)
        .zip(&sheet.vertices)
        .map(|(v, place)| {
            let faces = &around[v as usize];
            if faces.is_empty() || !features.is_free(v) {
                return *place;
            }
            let normal: Vector3<f64> = faces.iter().map(|f| sheet.normal(*f)).sum();
            let Some(normal) = normal.try_normalize(0.0) else { return *place };
            let corners = faces.iter().flat_map(|f| sheet.corners(*f));
            let pull = corners.map(|c| c - place).sum::<Vector3<f64>>() / (2 * faces.len()) as f64;
            place + (pull - normal * normal.dot(&pull)) * 0.5
        })
        .collect();
    sheet.vertices = moved;
}
