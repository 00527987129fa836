//! Which points stand for a cloud, and which neighbours they have.
//!
//! Everything here is a deterministic function of its arguments; ties go to the point
//! named first.

use seeone_core::vectorize::vectorize;

/// A point in the units of the network's input.
pub type Point = [f32; 3];

/// Points carried from coarse to fine: for each target three source rows and their shares.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Interpolation {
    /// Source rows of each target.
    pub rows: Vec<[u32; 3]>,
    /// Their shares, which sum to one.
    pub weights: Vec<[f32; 3]>,
}

/// Coordinates axis by axis, which the inner loops need to vectorise.
struct Columns([Vec<f32>; 3]);

impl Columns {
    fn new(points: &[Point]) -> Self {
        Self(std::array::from_fn(|axis| points.iter().map(|p| p[axis]).collect()))
    }

    /// Writes the squared distance of every point to `p`.
    #[inline(always)]
    fn squared_distances(&self, p: Point, out: &mut [f32]) {
        let [xs, ys, zs] = &self.0;
        for (((d, x), y), z) in out.iter_mut().zip(xs).zip(ys).zip(zs) {
            let (dx, dy, dz) = (x - p[0], y - p[1], z - p[2]);
            *d = dx * dx + dy * dy + dz * dz;
        }
    }
}

/// Farthest-point sampling (Eldar et al. 1997): `count` row numbers, the first of them 0,
/// each the farthest from all before it.
///
/// # Panics
/// When there are fewer than `count` points.
pub fn farthest_points(points: &[Point], count: usize) -> Vec<u32> {
    assert!(count <= points.len(), "cannot choose {count} of {} points", points.len());
    let columns = Columns::new(points);
    let mut nearest = vec![f32::INFINITY; points.len()];
    let mut distances = vec![0.0f32; points.len()];
    let mut chosen = Vec::with_capacity(count);
    let mut next = 0usize;
    while chosen.len() < count {
        chosen.push(next as u32);
        let mut farthest = f32::NEG_INFINITY;
        vectorize(
            #[inline(always)]
            || {
                columns.squared_distances(points[next], &mut distances);
                let mut lanes = [f32::NEG_INFINITY; 16];
                let (mut n, mut d) = (nearest.chunks_exact_mut(16), distances.chunks_exact(16));
                for (n, d) in (&mut n).zip(&mut d) {
                    for i in 0..16 {
                        n[i] = n[i].min(d[i]);
                        lanes[i] = lanes[i].max(n[i]);
                    }
                }
                for (n, d) in n.into_remainder().iter_mut().zip(d.remainder()) {
                    *n = n.min(*d);
                    farthest = farthest.max(*n);
                }
                farthest = lanes.iter().fold(farthest, |m, v| m.max(*v));
            },
        );
        next = nearest.iter().position(|d| *d == farthest).unwrap_or(0);
    }
    chosen
}

/// The first `count` points within `radius` of each centre, in the order of `points`;
/// the centre's own row fills up where there are fewer. `count` row numbers a centre.
///
/// With points in random order this is a random subset of the ball (PointNet++).
///
/// # Panics
/// When a centre is not a row of `points`.
pub fn ball_query(points: &[Point], centres: &[u32], radius: f32, count: usize) -> Vec<u32> {
    let columns = Columns::new(points);
    let limit = radius * radius;
    let mut distances = vec![0.0f32; points.len()];
    let mut rows = Vec::with_capacity(centres.len() * count);
    for &centre in centres {
        let full = rows.len() + count;
        vectorize(
            #[inline(always)]
            || columns.squared_distances(points[centre as usize], &mut distances),
        );
        let inside = distances.iter().enumerate().filter(|(_, d)| **d <= limit);
        rows.extend(inside.map(|(row, _)| row as u32).take(count));
        rows.resize(full, centre);
    }
    rows
}

/// The three nearest `sources` of each target with shares by inverse squared distance
/// (PointNet++, Eq. 2). With fewer than three sources the first one repeats.
///
/// # Panics
/// When there is no source.
pub fn three_nearest(targets: &[Point], sources: &[Point]) -> Interpolation {
    assert!(!sources.is_empty(), "nothing to interpolate from");
    let columns = Columns::new(sources);
    let mut distances = vec![0.0f32; sources.len()];
    let mut table = Interpolation::default();
    for &target in targets {
        vectorize(
            #[inline(always)]
            || columns.squared_distances(target, &mut distances),
        );
        let mut best = [(f32::INFINITY, 0u32); 3];
        for (row, &d) in distances.iter().enumerate() {
            if d < best[2].0 {
                best[2] = (d, row as u32);
                if best[2].0 < best[1].0 {
                    best.swap(1, 2);
                }
                if best[1].0 < best[0].0 {
                    best.swap(0, 1);
                }
            }
        }
        let shares = best.map(|(d, _)| 1.0 / (d + 1e-8));
        let total: f32 = shares.iter().sum();
        table.rows.push(best.map(|(_, row)| row));
        table.weights.push(shares.map(|s| s / total));
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_core::random::{generator, uniform};

    fn cloud(count: usize) -> Vec<Point> {
        let mut rng = generator(5, "cloud");
        (0..count).map(|_| std::array::from_fn(|_| uniform(&mut rng, -1.0, 1.0) as f32)).collect()
    }

    fn distance(a: Point, b: Point) -> f32 {
        (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f32>()
    }

    #[test]
    fn each_chosen_point_is_the_farthest_from_those_before() {
        let points = cloud(77);
        let chosen = farthest_points(&points, 12);
        for n in 1..12 {
            let to_chosen = |p: Point| {
                chosen[..n]
                    .iter()
                    .map(|c| distance(p, points[*c as usize]))
                    .fold(f32::INFINITY, f32::min)
            };
            let largest = points.iter().map(|p| to_chosen(*p)).fold(0.0, f32::max);
            assert_eq!(to_chosen(points[chosen[n] as usize]), largest);
        }
        assert_eq!(farthest_points(&[[0.0; 3]; 4], 3).len(), 3, "equal points do not end it");
    }

    #[test]
    fn a_ball_holds_what_is_near_and_fills_up_with_its_centre() {
        let points = cloud(200);
        let rows = ball_query(&points, &[3, 150], 0.3, 16);
        for (centre, group) in [3u32, 150].iter().zip(rows.chunks(16)) {
            assert!(group.contains(centre) || group.len() == 16);
            for row in group {
                assert!(
                    distance(points[*row as usize], points[*centre as usize]) <= 0.3f32.powi(2)
                );
            }
        }
        assert_eq!(ball_query(&points, &[9], 0.0, 4), [9; 4]);
    }

    #[test]
    fn shares_follow_the_nearest_three() {
        let (targets, sources) = (cloud(20), cloud(40));
        let table = three_nearest(&targets, &sources);
        assert_eq!(table.rows[7][0], 7, "a source is its own nearest");
        assert!(table.weights[7][0] > 0.999);
        for (target, rows) in targets.iter().zip(&table.rows) {
            let mut all: Vec<f32> = sources.iter().map(|s| distance(*target, *s)).collect();
            all.sort_by(f32::total_cmp);
            assert!((distance(*target, sources[rows[2] as usize]) - all[2]).abs() < 1e-6);
        }
        assert_eq!(three_nearest(&targets[..1], &sources[..1]).rows[0], [0; 3]);
    }
}
