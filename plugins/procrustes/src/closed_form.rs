//! The weighted least-squares similarity in closed form (Kabsch 1976, Umeyama 1991).

use nalgebra::{Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};
use seeone_core::Similarity;
use seeone_plugin::Correspondences;

/// Below this ratio of singular values (squared lengths) the points count as a line:
/// about a thousandth as wide as long.
const LINE: f64 = 1e-6;

/// A least-squares similarity and how well its rotation is determined.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fit {
    /// Source -> target; never a reflection.
    pub transform: Similarity,
    /// As [`seeone_plugin::AlignmentOutcome::condition`].
    pub condition: f64,
}

/// The similarity with the least weighted sum of squares, of the fixed scale where the
/// pairs name one. None where the points that weigh anything lie on a line or a spot, so
/// that any rotation round it would do.
pub(crate) fn fit(pairs: &Correspondences, weights: &[f64]) -> Option<Fit> {
    let total: f64 = weights.iter().sum();
    let source_centre = mean(pairs.source, weights, total);
    let target_centre = mean(pairs.target, weights, total);
    let mut covariance = Matrix3::zeros();
    let mut source_spread = 0.0;
    for ((p, q), w) in pairs.source.iter().zip(pairs.target).zip(weights) {
        let (p, q) = (p.coords - source_centre, q.coords - target_centre);
        covariance += q * p.transpose() * (w / total);
        source_spread += p.norm_squared() * (w / total);
    }

    let svd = covariance.svd(true, true);
    let (u, v_t) = (svd.u?, svd.v_t?);
    let [s1, s2, s3]: [f64; 3] = svd.singular_values.into();
    // The best orthogonal matrix may be a reflection; turning its weakest axis round makes
    // it the best rotation, which is determined by what is left of the second axis.
    let handedness = if (u * v_t).determinant() < 0.0 { -1.0 } else { 1.0 };
    let condition = (s2 + f64::min(handedness, 0.0) * s3) / s1;
    if !condition.is_finite() || condition < LINE {
        return None;
    }
    let flip = Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, handedness));
    let rotation =
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(u * flip * v_t));
    let scale = match pairs.fixed_scale {
        Some(scale) => scale,
        None => (s1 + s2 + handedness * s3) / source_spread,
    };
    if !scale.is_finite() || scale <= 0.0 {
        return None;
    }
    let shift = target_centre - rotation * source_centre * scale;
    let transform = Similarity::from_parts(Translation3::from(shift), rotation, scale);
    Some(Fit { transform, condition: condition.min(1.0) })
}

fn mean(points: &[Point3<f64>], weights: &[f64], total: f64) -> Vector3<f64> {
    points.iter().zip(weights).map(|(p, w)| p.coords * (w / total)).sum()
}
