//! Splitting long edges at their middle.

use super::super::sheet::{Edge, Sheet, edge};

/// Splits every edge longer than `longest` whose triangles no other split of this pass
/// has touched, the longest first. Returns how many were split.
pub fn pass(sheet: &mut Sheet, longest: f64) -> usize {
    let mut long: Vec<(Edge, Vec<usize>)> =
        sheet.edges().into_iter().filter(|(e, _)| sheet.length(*e) > longest).collect();
    long.sort_by(|a, b| sheet.length(b.0).total_cmp(&sheet.length(a.0)));
    let mut touched = vec![false; sheet.triangles.len()];
    let mut count = 0;
    for (e, faces) in long {
        if faces.iter().any(|f| touched[*f]) {
            continue;
        }
        let (a, b) = e;
        let middle = sheet.vertices.len() as u32;
        let place = nalgebra::center(&sheet.vertices[a as usize], &sheet.vertices[b as usize]);
        sheet.vertices.push(place);
        for f in faces {
            touched[f] = true;
            let whole = sheet.triangles[f];
            let Some(i) = (0..3).find(|i| edge(whole[*i], whole[(i + 1) % 3]) == e) else {
                continue;
            };
            let (from, to, apex) = (whole[i], whole[(i + 1) % 3], whole[(i + 2) % 3]);
            sheet.triangles[f] = [from, middle, apex];
            sheet.triangles.push([middle, to, apex]);
        }
        count += 1;
    }
    count
}
