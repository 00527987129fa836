//! Weighted least squares alignment (Umeyama 1991), without any robustness.

use nalgebra::{Matrix3, Point3, Rotation3, Translation3, UnitQuaternion, Vector3};
use seeone_core::Similarity;
use seeone_plugin::{Alignment, AlignmentOutcome, Correspondences, PluginError};

pub(crate) struct LeastSquares;

impl Alignment for LeastSquares {
    fn align(&self, pairs: &Correspondences) -> Result<AlignmentOutcome, PluginError> {
        if pairs.source.len() < 3 {
            return Err(PluginError::Input("fewer than three pairs".into()));
        }
        let total: f64 = pairs.weights.iter().sum();
        let mean = |points: &[Point3<f64>]| {
            points.iter().zip(pairs.weights).map(|(p, w)| p.coords * *w).sum::<Vector3<f64>>()
                / total
        };
        let (from, to) = (mean(pairs.source), mean(pairs.target));
        let mut cross = Matrix3::zeros();
        let mut spread = 0.0;
        for ((s, t), w) in pairs.source.iter().zip(pairs.target).zip(pairs.weights) {
            cross += (t.coords - to) * (s.coords - from).transpose() * *w;
            spread += (s.coords - from).norm_squared() * w;
        }
        let svd = cross.svd(true, true);
        let (u, v_t) = (svd.u.unwrap(), svd.v_t.unwrap());
        let sign = Vector3::new(1.0, 1.0, (u * v_t).determinant().signum());
        let rotation = u * Matrix3::from_diagonal(&sign) * v_t;
        let scale =
            pairs.fixed_scale.unwrap_or(svd.singular_values.component_mul(&sign).sum() / spread);
        let rotation =
            UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
        let translation = to - rotation * from * scale;
        Ok(AlignmentOutcome {
            transform: Similarity::from_parts(Translation3::from(translation), rotation, scale),
            residual: 0.0,
            inlier_share: 1.0,
            condition: svd.singular_values[2] / svd.singular_values[0],
        })
    }
}
