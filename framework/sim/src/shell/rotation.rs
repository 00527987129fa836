//! The rotation nearest to a matrix.

use nalgebra::{Matrix3, UnitQuaternion, Vector3};

/// Steps after which the fit is taken as it is; from a warm start two or three suffice.
const STEP_LIMIT: usize = 60;
/// Steps below this many radians end the fit. A looser fit of a narrow cluster such as a
/// visor loses angular momentum and turns its axis.
const TOLERANCE_RAD: f64 = 1e-12;

/// The rotation R that maximises tr(R^T `a`), found from `start`.
///
/// Newton's method on SO(3): with S the symmetric part of M = `a` R^T and g its axial
/// vector, the step solves (tr(S) I - S) w = g. Where that is not positive definite (far
/// from the optimum) it takes the gradient step of Mueller et al. 2016, which always
/// climbs.
pub fn nearest_rotation(a: &Matrix3<f64>, start: UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    let mut rotation = start;
    for _ in 0..STEP_LIMIT {
        let m = a * rotation.to_rotation_matrix().matrix().transpose();
        let axial = Vector3::new(m.m32 - m.m23, m.m13 - m.m31, m.m21 - m.m12);
        let symmetric = (m + m.transpose()) / 2.0;
        let trace = symmetric.trace();
        let step = (Matrix3::identity() * trace - symmetric)
            .cholesky()
            .map(|hessian| hessian.solve(&axial))
            .filter(|step| step.norm_squared() < 1.0)
            .unwrap_or_else(|| axial / (trace.abs() + 1e-9 * a.norm() + f64::MIN_POSITIVE));
        if !step.iter().all(|v| v.is_finite()) {
            break;
        }
        rotation = UnitQuaternion::from_scaled_axis(step) * rotation;
        if step.norm_squared() < TOLERANCE_RAD * TOLERANCE_RAD {
            break;
        }
    }
    UnitQuaternion::new_normalize(rotation.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn recovers_a_rotation_from_a_narrow_flat_cloud() {
        let true_rotation = UnitQuaternion::from_euler_angles(0.4, -0.9, 2.1);
        let spread = Matrix3::from_diagonal(&Vector3::new(1.0, 0.03, 1e-5));
        let a = true_rotation.to_rotation_matrix().matrix() * spread;
        let near = true_rotation * UnitQuaternion::from_euler_angles(0.1, 0.2, -0.1);
        for start in [UnitQuaternion::identity(), near] {
            let found = nearest_rotation(&a, start);
            assert!(found.angle_to(&true_rotation) < 1e-7, "{}", found.angle_to(&true_rotation));
        }
    }
}
