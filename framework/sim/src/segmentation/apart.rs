//! Points that lie apart from each other on a table.

use nalgebra::Point3;
use std::collections::BTreeMap;

/// The groups of `points` that lie apart from each other in the horizontal plane, in the order
/// of their first points. Of two groups no points are nearer than `apart_m / (2 sqrt 2)`, and
/// whatever is farther from everything else than `apart_m` (metres) is a group of its own.
///
/// Points share a group when the squares of a grid that they lie in touch, be it at a corner.
pub fn groups(points: Vec<Point3<f64>>, apart_m: f64) -> Vec<Vec<Point3<f64>>> {
    let edge_m = apart_m / 8.0_f64.sqrt();
    let square = |p: &Point3<f64>| [p.x, p.y].map(|v| (v / edge_m).floor() as i64);
    let mut group_of: BTreeMap<[i64; 2], Option<usize>> = BTreeMap::new();
    for point in &points {
        group_of.insert(square(point), None);
    }
    let mut groups: Vec<Vec<Point3<f64>>> = Vec::new();
    for point in points {
        let start = square(&point);
        if group_of[&start].is_none() {
            spread(&mut group_of, start, groups.len());
            groups.push(Vec::new());
        }
        let group = group_of[&start].expect("it has just been spread to its own square");
        groups[group].push(point);
    }
    groups
}

/// Gives `group` to the square `start` and to all that hang together with it.
fn spread(group_of: &mut BTreeMap<[i64; 2], Option<usize>>, start: [i64; 2], group: usize) {
    let mut open = vec![start];
    while let Some([x, y]) = open.pop() {
        if let Some(of @ None) = group_of.get_mut(&[x, y]) {
            *of = Some(group);
            open.extend((-1..=1).flat_map(|i| (-1..=1).map(move |j| [x + i, y + j])));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_apart_is_told_apart_and_what_hangs_together_is_not() {
        let row = |x: f64| (0..10).map(move |i| Point3::new(x + 0.02 * f64::from(i), 0.3, 0.1));
        let points: Vec<_> = row(0.0).chain(row(0.27)).collect();
        let told = groups(points.clone(), 0.08);
        assert_eq!(told, [row(0.0).collect::<Vec<_>>(), row(0.27).collect()]);
        assert_eq!(groups(points, 0.3).len(), 1);
        assert!(groups(Vec::new(), 0.08).is_empty());
    }
}
