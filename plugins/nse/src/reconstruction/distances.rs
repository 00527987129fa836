//! Distances between two sets of points.

use lapjv::{Matrix, lapjv};
use nalgebra::Point3;

/// The Chamfer distance in both usual formulas.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Chamfer {
    /// Mean distance to the nearest point of the other set, averaged over both directions.
    pub mean: f64,
    /// Mean squared distance to the nearest point of the other set, summed over both
    /// directions (Fan, Su and Guibas 2017, per point).
    pub squared: f64,
}

impl Chamfer {
    /// Between two sets, neither of them empty.
    pub fn between(a: &[Point3<f64>], b: &[Point3<f64>]) -> Self {
        let (there, back) = (nearest_squared(a, b), nearest_squared(b, a));
        let mean = |squares: &[f64], of: fn(f64) -> f64| {
            squares.iter().map(|s| of(*s)).sum::<f64>() / squares.len() as f64
        };
        Self {
            mean: 0.5 * (mean(&there, f64::sqrt) + mean(&back, f64::sqrt)),
            squared: mean(&there, |s| s) + mean(&back, |s| s),
        }
    }
}

/// Squared distance of each of `from` to the nearest of `to`.
fn nearest_squared(from: &[Point3<f64>], to: &[Point3<f64>]) -> Vec<f64> {
    let nearest =
        |p: &Point3<f64>| to.iter().map(|q| (p - q).norm_squared()).fold(f64::INFINITY, f64::min);
    from.iter().map(nearest).collect()
}

/// The earth mover's distance: the mean distance of the best one-to-one assignment, exact
/// (Jonker and Volgenant 1987); nothing for sets of different sizes.
pub fn earth_mover(a: &[Point3<f64>], b: &[Point3<f64>]) -> Option<f64> {
    if a.len() != b.len() || a.is_empty() {
        return None;
    }
    let cost = |(i, j): (usize, usize)| (a[i] - b[j]).norm();
    let costs = Matrix::from_shape_fn((a.len(), b.len()), cost);
    let (rows, _) = lapjv(&costs).ok()?;
    let total: f64 = rows.iter().enumerate().map(|(i, j)| cost((i, *j))).sum();
    Some(total / a.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_core::random::{generator, uniform};

    fn cloud(seed: u64) -> Vec<Point3<f64>> {
        let mut rng = generator(seed, "distances");
        (0..60).map(|_| Point3::from([(); 3].map(|()| uniform(&mut rng, 0.0, 1.0)))).collect()
    }

    #[test]
    fn a_small_shift_is_found_again_whatever_the_order() {
        let a = cloud(1);
        let shift = nalgebra::Vector3::new(0.003, 0.0, 0.004);
        let b: Vec<_> = a.iter().rev().map(|p| p + shift).collect();
        let moved = earth_mover(&a, &b).expect("equal sizes");
        assert!((moved - 0.005).abs() < 1e-9, "{moved}");
        let chamfer = Chamfer::between(&a, &b);
        assert!((chamfer.mean - 0.005).abs() < 1e-9);
        assert!((chamfer.squared - 2.0 * 0.005f64.powi(2)).abs() < 1e-12);
        assert_eq!(earth_mover(&a, &b[1..]), None);
    }

    #[test]
    fn moving_all_earth_costs_more_than_looking_for_the_nearest() {
        let (a, b) = (cloud(1), cloud(2));
        assert!(earth_mover(&a, &b).expect("equal sizes") > Chamfer::between(&a, &b).mean);
        assert_eq!(Chamfer::between(&a, &a), Chamfer::default());
    }
}
