//! The Paden-Kahan subproblems: angles of turns about unit axes through the origin.

use nalgebra::{UnitQuaternion, UnitVector3, Vector3};

/// Rotates `vector` by `angle` about `axis`.
pub(crate) fn turn(axis: &UnitVector3<f64>, angle: f64, vector: &Vector3<f64>) -> Vector3<f64> {
    UnitQuaternion::from_axis_angle(axis, angle) * vector
}

/// The angle that turns `from` about `axis` nearest to `to` (subproblem 1); `None` when
/// either is so nearly along the axis that the angle has no meaning.
pub(crate) fn between(
    axis: &UnitVector3<f64>,
    from: &Vector3<f64>,
    to: &Vector3<f64>,
) -> Option<f64> {
    let along = |v: &Vector3<f64>| v - axis.into_inner() * axis.dot(v);
    let (from, to) = (along(from), along(to));
    let negligible = from.norm().min(to.norm()) < 1e-9;
    (!negligible).then(|| axis.dot(&from.cross(&to)).atan2(from.dot(&to)))
}

/// The angles for which `h . turn(axis, angle, vector) = value` (subproblem 4): two, or
/// one repeated where they meet, or none where the value is out of reach by more than
/// `slack`.
pub(crate) fn projecting(
    h: &Vector3<f64>,
    axis: &UnitVector3<f64>,
    vector: &Vector3<f64>,
    value: f64,
    slack: f64,
) -> Vec<f64> {
    // h . turn(angle) = constant + cosine cos(angle) + sine sin(angle)
    let constant = h.dot(axis) * axis.dot(vector);
    let cosine = h.dot(vector) - constant;
    let sine = h.dot(&axis.cross(vector));
    meeting(cosine, sine, value - constant, slack)
}

/// The angles for which `|fixed + turn(axis, angle, vector)| = length`, all three vectors
/// perpendicular to the axis (subproblem 3).
pub(crate) fn reaching(
    axis: &UnitVector3<f64>,
    fixed: &Vector3<f64>,
    vector: &Vector3<f64>,
    length: f64,
    slack: f64,
) -> Vec<f64> {
    let value = 0.5 * (length * length - fixed.norm_squared() - vector.norm_squared());
    meeting(fixed.dot(vector), fixed.dot(&axis.cross(vector)), value, slack)
}

/// The angles for which `cosine cos + sine sin = value`.
fn meeting(cosine: f64, sine: f64, value: f64, slack: f64) -> Vec<f64> {
    let amplitude = cosine.hypot(sine);
    if amplitude < 1e-12 || value.abs() > amplitude + slack {
        return Vec::new();
    }
    let middle = sine.atan2(cosine);
    let half = (value / amplitude).clamp(-1.0, 1.0).acos();
    vec![middle + half, middle - half]
}

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_core::random::{direction, generator, uniform};

    #[test]
    fn each_finds_the_angle_it_was_made_from() {
        let mut rng = generator(3, "subproblem");
        for _ in 0..200 {
            let axis = UnitVector3::new_normalize(direction(&mut rng));
            let vector = direction(&mut rng) * uniform(&mut rng, 0.1, 2.0);
            let angle = uniform(&mut rng, -3.1, 3.1);
            let turned = turn(&axis, angle, &vector);
            let near =
                |found: f64| (found - angle).sin().abs() < 1e-6 && (found - angle).cos() > 0.0;
            assert!(near(between(&axis, &vector, &turned).expect("an angle")));
            let h = direction(&mut rng);
            let found = projecting(&h, &axis, &vector, h.dot(&turned), 0.0);
            assert!(found.into_iter().any(near));
            let flat = |v: &Vector3<f64>| v - axis.into_inner() * axis.dot(v);
            let (fixed, vector, turned) = (flat(&h), flat(&vector), flat(&turned));
            let found = reaching(&axis, &fixed, &vector, (fixed + turned).norm(), 0.0);
            assert!(found.into_iter().any(near));
        }
    }

    #[test]
    fn what_is_out_of_reach_has_no_angle() {
        let (x, z) = (Vector3::x(), Vector3::z_axis());
        assert!(projecting(&x, &z, &x, 1.5, 0.1).is_empty());
        assert!(reaching(&z, &x, &x, 2.5, 0.0).is_empty());
        assert_eq!(between(&z, &Vector3::z(), &x), None);
    }
}
