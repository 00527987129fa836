//! Cleaning: one connected sheet of whole triangles, wound alike, its normals outside.

use super::ImportFault;
use super::sheet::{Edge, Sheet, edge, edges_of};
use std::collections::{BTreeMap, BTreeSet};

/// Vertices nearer than this share of the bounding box's diagonal are one.
const WELD_SHARE: f64 = 1e-4;
/// A mesh with more of its area turned inside than this has two walls.
const TWO_WALLS: f64 = 0.25;

/// Welds, drops degenerate and doubled triangles, keeps the largest part, winds it alike
/// with the normals outside, and forgets vertices that nothing uses.
///
/// # Errors
/// [`ImportFault::NoFaces`] when nothing is left.
pub fn clean(sheet: &mut Sheet) -> Result<(), ImportFault> {
    weld(sheet);
    drop_degenerate(sheet);
    keep_largest_part(sheet);
    wind_alike(sheet);
    turn_outside(sheet);
    forget_loose_vertices(sheet);
    if sheet.triangles.is_empty() { Err(ImportFault::NoFaces) } else { Ok(()) }
}

/// Joins vertices that fall into one cell of a fine grid.
fn weld(sheet: &mut Sheet) {
    let (low, high) = sheet.bounds();
    let cell = ((high - low).norm() * WELD_SHARE).max(f64::MIN_POSITIVE);
    let mut first: BTreeMap<[i64; 3], u32> = BTreeMap::new();
    let same: Vec<u32> = (0u32..)
        .zip(&sheet.vertices)
        .map(|(i, v)| {
            let place: [i64; 3] = ((v - low) / cell).map(|c| c.round() as i64).into();
            *first.entry(place).or_insert(i)
        })
        .collect();
    for v in sheet.triangles.iter_mut().flatten() {
        *v = same[*v as usize];
    }
}

fn drop_degenerate(sheet: &mut Sheet) {
    let (low, high) = sheet.bounds();
    let smallest = ((high - low).norm() * WELD_SHARE).powi(2);
    let mut seen = BTreeSet::new();
    let kept = (0..sheet.triangles.len())
        .filter(|i| {
            let mut t = sheet.triangles[*i];
            t.sort_unstable();
            let whole = t[0] != t[1] && t[1] != t[2] && sheet.normal(*i).norm() > smallest;
            whole && seen.insert(t)
        })
        .map(|i| sheet.triangles[i])
        .collect();
    sheet.triangles = kept;
}

fn keep_largest_part(sheet: &mut Sheet) {
    let edges = sheet.edges();
    let mut part = vec![usize::MAX; sheet.triangles.len()];
    let mut areas: Vec<f64> = Vec::new();
    for start in 0..part.len() {
        if part[start] != usize::MAX {
            continue;
        }
        let number = areas.len();
        areas.push(0.0);
        part[start] = number;
        let mut open = vec![start];
        while let Some(i) = open.pop() {
            areas[number] += sheet.normal(i).norm();
            for e in edges_of(&sheet.triangles[i]) {
                for &other in edges.get(&e).into_iter().flatten() {
                    if part[other] == usize::MAX {
                        part[other] = number;
                        open.push(other);
                    }
                }
            }
        }
    }
    let largest = (0..areas.len()).max_by(|a, b| areas[*a].total_cmp(&areas[*b]));
    let mut parts = part.into_iter();
    sheet.triangles.retain(|_| parts.next() == largest);
}

/// Turns triangles so that neighbours run along their common edge in opposite directions.
fn wind_alike(sheet: &mut Sheet) {
    let edges = sheet.edges();
    let mut done = vec![false; sheet.triangles.len()];
    for start in 0..done.len() {
        if done[start] {
            continue;
        }
        done[start] = true;
        let mut open = vec![start];
        while let Some(i) = open.pop() {
            for e in edges_of(&sheet.triangles[i]) {
                let Some([a, b]) = edges.get(&e).map(Vec::as_slice) else { continue };
                let other = if *a == i { *b } else { *a };
                if done[other] {
                    continue;
                }
                if runs_forward(&sheet.triangles[i], e) == runs_forward(&sheet.triangles[other], e)
                {
                    sheet.triangles[other].swap(1, 2);
                }
                done[other] = true;
                open.push(other);
            }
        }
    }
}

fn runs_forward(t: &[u32; 3], (a, b): Edge) -> bool {
    (0..3).any(|i| t[i] == a && t[(i + 1) % 3] == b)
}

/// How much of the area looks away from a point far below the opening, with its sign for
/// each triangle: positive on the crown's outside and on the brim's upper side.
fn outward(sheet: &Sheet) -> Vec<f64> {
    let (low, high) = sheet.bounds();
    let mut below = nalgebra::center(&low, &high);
    below.z = low.z - (high.z - low.z);
    (0..sheet.triangles.len())
        .map(|i| sheet.normal(i).dot(&(sheet.centre(i) - below).normalize()))
        .collect()
}

fn turn_outside(sheet: &mut Sheet) {
    if outward(sheet).iter().sum::<f64>() < 0.0 {
        sheet.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
}

/// Of a mesh with an outer and an inner wall, keeps the outer one.
pub fn outer_wall(sheet: &mut Sheet) {
    let outward = outward(sheet);
    let total: f64 = outward.iter().map(|v| v.abs()).sum();
    let inside: f64 = outward.iter().filter(|v| **v < 0.0).map(|v| v.abs()).sum();
    if inside > TWO_WALLS * total {
        let mut each = outward.into_iter();
        sheet.triangles.retain(|_| each.next().is_some_and(|v| v > 0.0));
    }
}

fn forget_loose_vertices(sheet: &mut Sheet) {
    let used: BTreeSet<u32> = sheet.triangles.iter().flatten().copied().collect();
    let number: BTreeMap<u32, u32> = used.iter().copied().zip(0..).collect();
    sheet.vertices = used.iter().map(|v| sheet.vertices[*v as usize]).collect();
    for v in sheet.triangles.iter_mut().flatten() {
        *v = number[v];
    }
}

/// The edges with one triangle.
pub fn boundary(sheet: &Sheet) -> BTreeSet<Edge> {
    sheet.edges().into_iter().filter(|(_, t)| t.len() == 1).map(|(e, _)| edge(e.0, e.1)).collect()
}
