//! Flipping edges so that vertices have six neighbours inside and four at a boundary.

use super::super::sheet::{Edge, Sheet, edge};
use super::Features;
use std::collections::BTreeSet;

/// The two new faces may deviate from the old ones by no more than this (cosine).
const LARGEST_TURN_COS: f64 = 0.9;

/// Flips every edge that brings the valences nearer to even. Returns how many.
pub fn pass(sheet: &mut Sheet) -> usize {
    let features = Features::of(sheet);
    let edges = sheet.edges();
    let mut existing: BTreeSet<Edge> = edges.keys().copied().collect();
    let mut valence = vec![0i32; sheet.vertices.len()];
    for (a, b) in &existing {
        valence[*a as usize] += 1;
        valence[*b as usize] += 1;
    }
    let mut touched = vec![false; sheet.triangles.len()];
    let mut count = 0;
    for (e, faces) in &edges {
        let [f, g] = faces.as_slice() else { continue };
        if features.edges.contains(e) || touched[*f] || touched[*g] {
            continue;
        }
        let (Some((a, b, c)), Some((_, _, d))) =
            (seen_from(&sheet.triangles[*f], *e), seen_from(&sheet.triangles[*g], *e))
        else {
            continue;
        };
        let off = |v: u32, change: i32| {
            let wanted = if features.is_free(v) { 6 } else { 4 };
            (valence[v as usize] + change - wanted).pow(2)
        };
        let before = off(a, 0) + off(b, 0) + off(c, 0) + off(d, 0);
        let after = off(a, -1) + off(b, -1) + off(c, 1) + off(d, 1);
        if after >= before || existing.contains(&edge(c, d)) || !stays_flat(sheet, [a, b, c, d], *f)
        {
            continue;
        }
        sheet.triangles[*f] = [a, d, c];
        sheet.triangles[*g] = [d, b, c];
        existing.remove(e);
        existing.insert(edge(c, d));
        for (v, change) in [(a, -1), (b, -1), (c, 1), (d, 1)] {
            valence[v as usize] += change;
        }
        (touched[*f], touched[*g]) = (true, true);
        count += 1;
    }
    count
}

/// The edge's ends in the triangle's order, and the triangle's third corner.
fn seen_from(t: &[u32; 3], e: Edge) -> Option<(u32, u32, u32)> {
    let i = (0..3).find(|i| edge(t[*i], t[(i + 1) % 3]) == e)?;
    Some((t[i], t[(i + 1) % 3], t[(i + 2) % 3]))
}

fn stays_flat(sheet: &Sheet, [a, b, c, d]: [u32; 4], face: usize) -> bool {
    let old = sheet.normal(face);
    [[a, d, c], [d, b, c]].iter().all(|t| {
        let [p, q, r] = t.map(|v| sheet.vertices[v as usize]);
        let new = (q - p).cross(&(r - p));
        new.dot(&old) > LARGEST_TURN_COS * new.norm() * old.norm()
    })
}
