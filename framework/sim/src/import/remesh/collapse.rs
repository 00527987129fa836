//! Collapsing short edges.

use super::super::sheet::{Edge, Sheet};
use super::{Features, faces_around};
use nalgebra::Point3;
use std::collections::BTreeSet;

/// A face may turn by no more than this when a corner of it moves (cosine).
const LARGEST_TURN_COS: f64 = 0.5;

/// Collapses edges shorter than `shortest`, the shortest first, where the surface keeps
/// its form and no edge becomes longer than `longest`. Returns how many were collapsed.
pub fn pass(sheet: &mut Sheet, shortest: f64, longest: f64) -> usize {
    let features = Features::of(sheet);
    let around = faces_around(sheet);
    let mut short: Vec<(Edge, Vec<usize>)> =
        sheet.edges().into_iter().filter(|(e, _)| sheet.length(*e) < shortest).collect();
    short.sort_by(|a, b| sheet.length(a.0).total_cmp(&sheet.length(b.0)));
    let mut touched = vec![false; sheet.triangles.len()];
    let mut gone = vec![false; sheet.triangles.len()];
    let mut count = 0;
    for ((a, b), faces) in short {
        let both: BTreeSet<usize> =
            around[a as usize].iter().chain(&around[b as usize]).copied().collect();
        if both.iter().any(|f| touched[*f]) {
            continue;
        }
        let Some(place) = meeting_place(sheet, &features, (a, b)) else { continue };
        let kept: Vec<usize> = both.iter().copied().filter(|f| !faces.contains(f)).collect();
        if common_neighbours(sheet, &around, (a, b)) != faces.len()
            || kept.iter().any(|f| !survives(sheet, *f, (a, b), &place, longest))
        {
            continue;
        }
        // The whole neighbourhood is out of bounds for the rest of the pass.
        for f in &both {
            for v in sheet.triangles[*f] {
                around[v as usize].iter().for_each(|f| touched[*f] = true);
            }
        }
        sheet.vertices[a as usize] = place;
        for f in kept {
            sheet.triangles[f].iter_mut().filter(|v| **v == b).for_each(|v| *v = a);
        }
        faces.iter().for_each(|f| gone[*f] = true);
        count += 1;
    }
    let mut gone = gone.into_iter();
    sheet.triangles.retain(|_| gone.next() != Some(true));
    count
}

/// Where the two ends may meet, if anywhere: a corner stays, a feature is left by nothing.
fn meeting_place(sheet: &Sheet, features: &Features, (a, b): Edge) -> Option<Point3<f64>> {
    let (from, to) = (sheet.vertices[a as usize], sheet.vertices[b as usize]);
    match (features.is_free(a), features.is_free(b)) {
        (true, true) => Some(nalgebra::center(&from, &to)),
        (true, false) => Some(to),
        (false, true) => Some(from),
        (false, false) if !features.edges.contains(&(a, b)) => None,
        (false, false) => match (features.is_corner(a), features.is_corner(b)) {
            (true, true) => None,
            (true, false) => Some(from),
            (false, true) => Some(to),
            (false, false) => Some(nalgebra::center(&from, &to)),
        },
    }
}

/// Number of vertices that are neighbours of both ends. The surface keeps its topology only
/// if these are the far corners of the edge's own triangles (link condition).
fn common_neighbours(sheet: &Sheet, around: &[Vec<usize>], (a, b): Edge) -> usize {
    let neighbours = |v: u32| -> BTreeSet<u32> {
        around[v as usize].iter().flat_map(|f| sheet.triangles[*f]).filter(|n| *n != v).collect()
    };
    neighbours(a).intersection(&neighbours(b)).count()
}

/// Whether face `f` stays a sound triangle when its corner `a` or `b` moves to `place`.
fn survives(sheet: &Sheet, f: usize, (a, b): Edge, place: &Point3<f64>, longest: f64) -> bool {
    let before = sheet.normal(f);
    let [p, q, r] = sheet.triangles[f]
        .map(|v| if v == a || v == b { *place } else { sheet.vertices[v as usize] });
    let after = (q - p).cross(&(r - p));
    let sound = after.dot(&before) > LARGEST_TURN_COS * after.norm() * before.norm();
    sound && [(p, q), (q, r), (r, p)].iter().all(|(x, y)| (x - y).norm() < longest)
}
