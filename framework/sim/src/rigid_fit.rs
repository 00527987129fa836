//! The rigid motion that best carries one vertex set onto another (Kabsch 1976). The
//! world's own yardstick, for labels and verdicts; plugins align with `alignment`.

use nalgebra::{Matrix3, Point3, Rotation3, UnitQuaternion, Vector3};
use seeone_core::Pose;

/// The pose that carries `from` nearest to `to` in the least squares sense. Both slices
/// have one length; fewer than three points give a pure translation.
pub fn rigid_fit(from: &[Point3<f64>], to: &[Point3<f64>]) -> Pose {
    let (centre_from, centre_to) = (centroid(from), centroid(to));
    let mut covariance = Matrix3::zeros();
    for (a, b) in from.iter().zip(to) {
        covariance += (b - centre_to) * (a - centre_from).transpose();
    }
    let svd = covariance.svd(true, true);
    let rotation = match (svd.u, svd.v_t) {
        (Some(u), Some(v_t)) if from.len() >= 3 => {
            let handed = (u * v_t).determinant().signum();
            let mut order = svd.singular_values;
            // The reflection, if any, goes to the least determined direction.
            let least = order.imin();
            order.fill(1.0);
            order[least] = handed;
            Rotation3::from_matrix_unchecked(u * Matrix3::from_diagonal(&order) * v_t)
        }
        _ => Rotation3::identity(),
    };
    let rotation = UnitQuaternion::from_rotation_matrix(&rotation);
    Pose::from_parts((centre_to - rotation * centre_from).into(), rotation)
}

fn centroid(points: &[Point3<f64>]) -> Point3<f64> {
    let sum: Vector3<f64> = points.iter().map(|p| p.coords).sum();
    Point3::from(sum / points.len().max(1) as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn finds_a_known_motion_of_a_flat_patch() {
        let flat: Vec<_> =
            (0..12).map(|i| Point3::new((i % 4) as f64, (i / 4) as f64 * 0.5, 0.0)).collect();
        let motion = Pose::new(Vector3::new(0.3, -0.2, 0.9), Vector3::new(0.4, 2.0, -0.7));
        let moved: Vec<_> = flat.iter().map(|p| motion * p).collect();
        let (distance, angle) = seeone_core::pose::difference(&motion, &rigid_fit(&flat, &moved));
        assert!(distance < 1e-9 && angle < 1e-7, "{distance} {angle}");
    }
}
