//! Of many points, the few that span their convex hull.

use nalgebra::{Point3, Vector3};
use std::collections::BTreeSet;
use std::f64::consts::PI;

/// The points furthest along `directions` directions spread evenly over the sphere, each once
/// and in their order: of a cloud, what its convex hull needs. Of a ball's surface the hull of 128 of
/// them lies nowhere deeper below it than a thirtieth of its radius.
pub fn extremes(points: &[Point3<f64>], directions: usize) -> Vec<Point3<f64>> {
    let furthest = |direction: Vector3<f64>| {
        let along = points.iter().map(|p| p.coords.dot(&direction));
        along.enumerate().max_by(|a, b| a.1.total_cmp(&b.1)).map(|(index, _)| index)
    };
    let found: BTreeSet<usize> =
        (0..directions).filter_map(|k| furthest(direction(k, directions))).collect();
    found.into_iter().map(|index| points[index]).collect()
}

/// The `k`th of `count` directions on a spiral that turns by the golden angle.
fn direction(k: usize, count: usize) -> Vector3<f64> {
    let z = 1.0 - (2.0 * k as f64 + 1.0) / count as f64;
    let (radius, turn) = ((1.0 - z * z).sqrt(), PI * (3.0 - 5f64.sqrt()) * k as f64);
    Vector3::new(radius * turn.cos(), radius * turn.sin(), z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{direction as drawn, generator};

    #[test]
    fn the_corners_of_a_box_are_found_and_nothing_within_it() {
        let corners = (0..8).map(|k| {
            let edge = |bit: usize| if k >> bit & 1 == 0 { -0.1 } else { 0.2 };
            Point3::new(edge(0), edge(1), edge(2))
        });
        let corners: Vec<_> = corners.collect();
        let within = (0..50).map(|k| Point3::new(0.003 * f64::from(k), 0.0, 0.05));
        let cloud: Vec<_> = within.chain(corners.iter().copied()).collect();
        assert_eq!(extremes(&cloud, 128), corners);
        assert_eq!(extremes(&[], 128), []);
    }

    #[test]
    fn of_a_ball_little_is_cut_off() {
        let mut rng = generator(1, "extremes");
        let ball: Vec<_> = (0..20_000).map(|_| Point3::from(drawn(&mut rng))).collect();
        let few = extremes(&ball, 128);
        assert!(few.len() <= 128);
        for _ in 0..2000 {
            let along = drawn(&mut rng);
            let reach = few.iter().map(|p| p.coords.dot(&along)).fold(f64::MIN, f64::max);
            assert!(reach > 1.0 - 1.0 / 30.0, "{reach}");
        }
    }
}
