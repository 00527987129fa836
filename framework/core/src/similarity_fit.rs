//! The similarity that carries one point set onto another, in the presence of outliers.

use crate::Similarity;
use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};

/// Reweightings: the robust fit has settled long before.
const ITERATIONS: usize = 10;

/// The similarity of least weighted squares from `source` to `target` (Umeyama 1991), never
/// a reflection. `None` for slices of different lengths, fewer than three pairs of positive
/// weight, numbers that are not finite, or sources all in one place. Of sources on one line
/// the turn about that line is arbitrary.
pub fn weighted_similarity(
    source: &[Point3<f64>],
    target: &[Point3<f64>],
    weights: &[f64],
) -> Option<Similarity> {
    let pairs =
        || source.iter().zip(target).zip(weights).map(|((s, t), w)| (s.coords, t.coords, *w));
    let total: f64 = weights.iter().sum();
    let enough = weights.iter().filter(|w| **w > 0.0).count() >= 3;
    let equal = source.len() == target.len() && source.len() == weights.len();
    if !(equal && enough && total.is_finite()) {
        return None;
    }
    let from = pairs().map(|(s, _, w)| s * w).sum::<Vector3<f64>>() / total;
    let to = pairs().map(|(_, t, w)| t * w).sum::<Vector3<f64>>() / total;
    let mut covariance = Matrix3::zeros();
    let mut spread = 0.0;
    for (s, t, w) in pairs() {
        covariance += (t - to) * (s - from).transpose() * w;
        spread += (s - from).norm_squared() * w;
    }
    // The mean's rounding leaves a spread of about (1e-16 |mean|)^2 where there is none.
    let extended = spread > 1e-24 * total * from.norm_squared();
    if !(extended && covariance.iter().all(|v| v.is_finite())) {
        return None;
    }
    let svd = covariance.svd(true, true);
    let (u, v_t) = (svd.u?, svd.v_t?);
    let mut signs = Vector3::repeat(1.0);
    if (u * v_t).determinant() < 0.0 {
        signs[svd.singular_values.imin()] = -1.0;
    }
    let rotation = Rotation3::from_matrix_unchecked(u * Matrix3::from_diagonal(&signs) * v_t);
    let scale = svd.singular_values.dot(&signs) / spread;
    if !(scale.is_finite() && scale > 0.0) {
        return None;
    }
    let isometry = Isometry3::from_parts(
        Translation3::from(to - rotation * from * scale),
        UnitQuaternion::from_rotation_matrix(&rotation),
    );
    Some(Similarity::from_isometry(isometry, scale))
}

/// As [`weighted_similarity`], reweighted by Cauchy's function of the residuals, whose
/// width is their median: a pair far off pulls ever less.
pub fn robust_similarity(
    source: &[Point3<f64>],
    target: &[Point3<f64>],
    weights: &[f64],
) -> Option<Similarity> {
    let mut fit = weighted_similarity(source, target, weights)?;
    for _ in 0..ITERATIONS {
        let residuals: Vec<f64> =
            source.iter().zip(target).map(|(s, t)| (fit * s - t).norm()).collect();
        let mut sorted = residuals.clone();
        sorted.sort_by(f64::total_cmp);
        let width = sorted[sorted.len() / 2];
        if width <= f64::EPSILON {
            break;
        }
        let reweighted: Vec<f64> =
            weights.iter().zip(&residuals).map(|(w, r)| w / (1.0 + (r / width).powi(2))).collect();
        fit = weighted_similarity(source, target, &reweighted)?;
    }
    Some(fit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{generator, normal, uniform};

    fn scene() -> (Similarity, Vec<Point3<f64>>, Vec<Point3<f64>>) {
        let truth =
            Similarity::new(Vector3::new(0.3, -0.2, 0.9), Vector3::new(2.0, 0.5, -1.0), 4.0);
        let mut rng = generator(1, "points");
        let source: Vec<_> = (0..200)
            .map(|_| Point3::from(Vector3::from_fn(|_, _| uniform(&mut rng, -1.0, 1.0))))
            .collect();
        let target = source.iter().map(|p| truth * p).collect();
        (truth, source, target)
    }

    fn angle(a: &Similarity, b: &Similarity) -> f64 {
        a.isometry.rotation.angle_to(&b.isometry.rotation)
    }

    #[test]
    fn finds_the_exact_similarity() {
        let (truth, source, target) = scene();
        let fit = weighted_similarity(&source, &target, &vec![0.5; 200]).expect("a fit");
        assert!(angle(&fit, &truth) < 1e-7 && (fit.scaling() - 4.0).abs() < 1e-9);
        assert!(
            (fit.isometry.translation.vector - truth.isometry.translation.vector).norm() < 1e-9
        );
    }

    #[test]
    fn outliers_spoil_the_plain_fit_but_not_the_robust_one() {
        let (truth, source, mut target) = scene();
        let mut rng = generator(2, "noise");
        for (i, p) in target.iter_mut().enumerate() {
            p.coords += Vector3::from_fn(|_, _| 0.01 * normal(&mut rng));
            if i % 4 == 0 {
                *p = Point3::new(3.0, -8.0, 1.0 + p.z);
            }
        }
        let weights = vec![1.0; 200];
        let plain = weighted_similarity(&source, &target, &weights).expect("a fit");
        let robust = robust_similarity(&source, &target, &weights).expect("a fit");
        assert!(angle(&plain, &truth) > 0.1, "{}", angle(&plain, &truth));
        assert!(angle(&robust, &truth) < 0.02, "{}", angle(&robust, &truth));
    }

    #[test]
    fn never_reflects_and_refuses_what_determines_nothing() {
        let (_, source, target) = scene();
        let mirrored: Vec<_> = target.iter().map(|p| Point3::new(-p.x, p.y, p.z)).collect();
        if let Some(fit) = weighted_similarity(&source, &mirrored, &vec![1.0; 200]) {
            let rotation = fit.isometry.rotation.to_rotation_matrix();
            assert!((rotation.matrix().determinant() - 1.0).abs() < 1e-9);
        }
        assert!(weighted_similarity(&source[..2], &target[..2], &[1.0; 2]).is_none());
        assert!(weighted_similarity(&source[..9], &target[..9], &[f64::NAN; 9]).is_none());
        assert!(weighted_similarity(&[source[0]; 5], &target[..5], &[1.0; 5]).is_none());
        assert!(weighted_similarity(&source, &target[..5], &[1.0; 5]).is_none());
    }
}
