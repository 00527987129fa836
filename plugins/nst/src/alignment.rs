//! Poses from correspondences: observed points -> centred canonical coordinates
//! (`nocs - 0.5`).

use nalgebra::{Matrix2x3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector2, Vector3};
use seeone_core::Similarity;

/// Residual in canonical units at which a correspondence counts half.
const SOFTNESS: f64 = 0.05;
const ROUNDS: usize = 12;
/// Search for the mirror plane: half range and step in canonical units.
const SLIDE: (f64, f64) = (0.6, 0.01);

/// The similarity that brings `from` nearest to `to` in the weighted least-squares sense
/// (Umeyama 1991); nothing when the points determine none.
pub fn least_squares(
    from: &[Vector3<f64>],
    to: &[Vector3<f64>],
    weights: &[f64],
) -> Option<Similarity> {
    let total: f64 = weights.iter().sum();
    if !(total > 0.0 && total.is_finite()) {
        return None;
    }
    let mean = |points: &[Vector3<f64>]| -> Vector3<f64> {
        points.iter().zip(weights).map(|(p, w)| p * *w).sum::<Vector3<f64>>() / total
    };
    let (mean_from, mean_to) = (mean(from), mean(to));
    let (mut correlation, mut spread) = (Matrix3::zeros(), 0.0);
    for ((a, b), w) in from.iter().zip(to).zip(weights) {
        let (a, b) = (a - mean_from, b - mean_to);
        correlation += b * a.transpose() * *w;
        spread += w * a.norm_squared();
    }
    let svd = correlation.svd(true, true);
    let (u, v_t) = (svd.u?, svd.v_t?);
    let mut signs = Vector3::repeat(1.0);
    if (u * v_t).determinant() < 0.0 {
        signs[svd.singular_values.imin()] = -1.0; // a rotation, never a reflection
    }
    let rotation = u * Matrix3::from_diagonal(&signs) * v_t;
    let scale = svd.singular_values.dot(&signs) / spread;
    if !(scale > 0.0 && scale.is_finite()) {
        return None;
    }
    let rotation =
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
    let shift = mean_to - rotation * mean_from * scale;
    Some(Similarity::from_parts(Translation3::from(shift), rotation, scale))
}

fn apply(pose: &Similarity, p: &Vector3<f64>) -> Vector3<f64> {
    pose.transform_point(&(*p).into()).coords
}

/// Cauchy weight of a residual.
fn weight(residual: f64) -> f64 {
    1.0 / (1.0 + (residual / SOFTNESS).powi(2))
}

/// As [`least_squares`], reweighted (IRLS) so that correspondences far off count little.
pub fn robust(from: &[Vector3<f64>], to: &[Vector3<f64>], weights: &[f64]) -> Option<Similarity> {
    let mut pose = least_squares(from, to, weights)?;
    for _ in 0..ROUNDS {
        let reweighted: Vec<f64> = from
            .iter()
            .zip(to)
            .zip(weights)
            .map(|((a, b), w)| w * weight((apply(&pose, a) - b).norm()))
            .collect();
        pose = least_squares(from, to, &reweighted)?;
    }
    Some(pose)
}

/// A pose from folded coordinates `[|x|, y, z]`: where a point lies, but not on which side
/// of the mirror plane.
///
/// The two rows of the pose that give `y` and `z` come from an affine fit; the third is
/// their cross product, because the object is never reflected; the mirror plane slides to
/// where `|x|` fits best. Then each point takes the side on which the pose puts it, and the
/// whole is refined as in [`robust`], sides included.
pub fn folded(from: &[Vector3<f64>], to: &[Vector3<f64>], weights: &[f64]) -> Option<Similarity> {
    let mut pose = slide(from, to, weights, &rows_of_y_and_z(from, to, weights)?)?;
    for _ in 0..2 * ROUNDS {
        let (mut sided, mut reweighted) =
            (Vec::with_capacity(to.len()), Vec::with_capacity(to.len()));
        for ((a, b), w) in from.iter().zip(to).zip(weights) {
            let placed = apply(&pose, a);
            let target = Vector3::new(b.x.copysign(placed.x), b.y, b.z);
            reweighted.push(w * weight((placed - target).norm()));
            sided.push(target);
        }
        pose = least_squares(from, &sided, &reweighted)?;
    }
    Some(pose)
}

/// Robust affine fit of `y` and `z`, made a scaled rotation; its `x` offset is left at 0.
fn rows_of_y_and_z(
    from: &[Vector3<f64>],
    to: &[Vector3<f64>],
    weights: &[f64],
) -> Option<Similarity> {
    let mut current = weights.to_vec();
    let mut result = None;
    for _ in 0..ROUNDS {
        let total: f64 = current.iter().sum();
        let mut mean_from = Vector3::zeros();
        let mut mean_to = Vector2::zeros();
        for ((a, b), w) in from.iter().zip(to).zip(&current) {
            mean_from += a * (w / total);
            mean_to += b.yz() * (w / total);
        }
        let (mut cross, mut moment) = (Matrix2x3::zeros(), Matrix3::zeros());
        for ((a, b), w) in from.iter().zip(to).zip(&current) {
            let (a, b) = (a - mean_from, b.yz() - mean_to);
            cross += b * a.transpose() * *w;
            moment += a * a.transpose() * *w;
        }
        // A little of the identity keeps a flat patch solvable.
        moment += Matrix3::identity() * (1e-3 * moment.trace());
        let affine = cross * moment.try_inverse()?;
        let svd = affine.svd(true, true);
        let rows = svd.u? * svd.v_t?; // nearest matrix with orthonormal rows
        let scale = svd.singular_values.mean();
        let (y, z) = (rows.row(0).transpose(), rows.row(1).transpose());
        let rotation = Matrix3::from_rows(&[y.cross(&z).transpose(), y.transpose(), z.transpose()]);
        if !(scale > 0.0 && rotation.iter().all(|v| v.is_finite())) {
            return None;
        }
        let rotation =
            UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
        let moved = rotation * mean_from * scale;
        let shift = Translation3::new(0.0, mean_to.x - moved.y, mean_to.y - moved.z);
        let pose = Similarity::from_parts(shift, rotation, scale);
        for (((a, b), w), start) in from.iter().zip(to).zip(&mut current).zip(weights) {
            *w = start * weight((apply(&pose, a).yz() - b.yz()).norm());
        }
        result = Some(pose);
    }
    result
}

/// Moves `pose` along `x` to where `|x|` fits best.
fn slide(
    from: &[Vector3<f64>],
    to: &[Vector3<f64>],
    weights: &[f64],
    pose: &Similarity,
) -> Option<Similarity> {
    let xs: Vec<f64> = from.iter().map(|a| apply(pose, a).x).collect();
    let total: f64 = weights.iter().sum();
    let mean = xs.iter().zip(weights).map(|(x, w)| x * w).sum::<f64>() / total;
    let cost = |shift: f64| -> f64 {
        let terms = xs.iter().zip(to).zip(weights);
        terms.map(|((x, b), w)| w * ((x + shift).abs() - b.x).abs()).sum()
    };
    let steps = (2.0 * SLIDE.0 / SLIDE.1).round() as i32;
    let best = (0..=steps)
        .map(|i| f64::from(i) * SLIDE.1 - SLIDE.0 - mean)
        .min_by(|a, b| cost(*a).total_cmp(&cost(*b)))?;
    let mut moved = *pose;
    moved.isometry.translation.x += best;
    Some(moved)
}

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_core::random::{Generator, generator, normal, rotation, uniform};

    /// Points on a curved, mirror-symmetric patch, and the pose that canonicalises them.
    fn scene(rng: &mut Generator) -> (Vec<Vector3<f64>>, Vec<Vector3<f64>>, Similarity) {
        let shift = Vector3::from_fn(|_, _| uniform(rng, -1.0, 1.0));
        let pose = Similarity::from_parts(shift.into(), rotation(rng), uniform(rng, 3.0, 4.0));
        let to: Vec<Vector3<f64>> = (0..300)
            .map(|_| {
                let (x, y) = (uniform(rng, -0.35, 0.3), uniform(rng, -0.4, 0.45));
                Vector3::new(x, y, 0.3 - x * x - 0.5 * y * y)
            })
            .collect();
        let back = pose.inverse();
        (to.iter().map(|p| apply(&back, p)).collect(), to, pose)
    }

    fn angle(a: &Similarity, b: &Similarity) -> f64 {
        a.isometry.rotation.angle_to(&b.isometry.rotation).to_degrees()
    }

    #[test]
    fn robust_fit_ignores_a_tenth_far_off() {
        let mut rng = generator(1, "alignment");
        for _ in 0..20 {
            let (from, mut to, pose) = scene(&mut rng);
            for p in to.iter_mut().step_by(10) {
                p.x += 0.5;
            }
            let weights = vec![1.0; from.len()];
            let fit = robust(&from, &to, &weights).expect("a fit");
            assert!(angle(&fit, &pose) < 1.0, "{}", angle(&fit, &pose));
            let plain = least_squares(&from, &to, &weights).expect("a fit");
            assert!(angle(&fit, &pose) < angle(&plain, &pose));
        }
        assert!(least_squares(&[Vector3::zeros(); 4], &[Vector3::zeros(); 4], &[1.0; 4]).is_none());
    }

    #[test]
    fn folded_coordinates_give_the_pose_and_its_handedness() {
        let mut rng = generator(2, "alignment");
        for _ in 0..50 {
            let (from, to, pose) = scene(&mut rng);
            let noisy: Vec<Vector3<f64>> = to
                .iter()
                .map(|p| {
                    let mut noise = || 0.02 * normal(&mut rng);
                    Vector3::new((p.x.abs() + noise()).max(0.0), p.y + noise(), p.z + noise())
                })
                .collect();
            let fit = folded(&from, &noisy, &vec![1.0; from.len()]).expect("a fit");
            assert!(angle(&fit, &pose) < 5.0, "{} degrees off", angle(&fit, &pose));
            let worst =
                from.iter().zip(&to).map(|(a, b)| (apply(&fit, a) - b).norm()).fold(0.0, f64::max);
            assert!(worst < 0.06, "{worst} off");
        }
    }
}
