//! An ellipsoid and the distance from it.

use nalgebra::{Point3, Vector3};

/// Newton steps for the foot of a perpendicular; near the surface three suffice.
const STEP_LIMIT: usize = 40;

/// An ellipsoid about the origin with its axes along x, y and z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    /// Semi-axes, metres, positive.
    pub semi_axes: Vector3<f64>,
}

impl Ellipsoid {
    /// Whether `p` is inside.
    #[inline]
    pub fn contains(&self, p: &Point3<f64>) -> bool {
        p.coords.component_div(&self.semi_axes).norm_squared() < 1.0
    }

    /// Distance of `p` from the surface, negative inside, and the outward normal at the
    /// nearest surface point.
    ///
    /// The nearest point is a_i^2 p_i / (a_i^2 + t) where t is the largest root of
    /// sum (a_i p_i / (a_i^2 + t))^2 = 1 (Eberly, Distance from a Point to an Ellipsoid).
    /// The sum is convex and falling there, so that Newton's method climbs to the root
    /// from any start left of it.
    pub fn signed_distance(&self, p: &Point3<f64>) -> (f64, Vector3<f64>) {
        let squares = self.semi_axes.component_mul(&self.semi_axes);
        let scaled = self.semi_axes.component_mul(&p.coords);
        let smallest = squares.min();
        // One term alone already exceeds one at this start, unless p is the centre.
        let start = (0..3).map(|k| scaled[k].abs() - squares[k]).fold(f64::NEG_INFINITY, f64::max);
        let mut t = start.max(-smallest * (1.0 - 1e-9));
        for _ in 0..STEP_LIMIT {
            let denominators = squares.add_scalar(t);
            let ratios = scaled.component_div(&denominators);
            let excess = ratios.norm_squared() - 1.0;
            let slope = -2.0 * ratios.component_mul(&ratios).component_div(&denominators).sum();
            if slope >= 0.0 || excess <= 1e-15 {
                break;
            }
            t -= excess / slope;
        }
        let foot = squares.component_mul(&p.coords).component_div(&squares.add_scalar(t));
        let normal = foot.component_div(&squares).try_normalize(0.0).unwrap_or_else(Vector3::z);
        ((p.coords - foot).dot(&normal), normal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_core::random::{direction, generator, uniform};

    #[test]
    fn a_point_put_along_the_normal_is_that_far_away() {
        let body = Ellipsoid { semi_axes: Vector3::new(0.077, 0.099, 0.110) };
        let mut rng = generator(3, "ellipsoid");
        for _ in 0..500 {
            let surface = direction(&mut rng).component_mul(&body.semi_axes);
            let squares = body.semi_axes.component_mul(&body.semi_axes);
            let normal = surface.component_div(&squares).normalize();
            let distance = uniform(&mut rng, -0.03, 0.2);
            let p = Point3::from(surface + normal * distance);
            let (found, direction) = body.signed_distance(&p);
            assert!((found - distance).abs() < 1e-9, "{found} for {distance}");
            assert!((direction - normal).norm() < 1e-6);
            assert_eq!(body.contains(&p), distance < 0.0);
        }
    }

    #[test]
    fn the_centre_has_a_finite_answer() {
        let body = Ellipsoid { semi_axes: Vector3::new(0.077, 0.099, 0.110) };
        let (distance, normal) = body.signed_distance(&Point3::origin());
        assert!(distance.is_finite() && distance <= 0.0 && normal.norm() > 0.99);
    }
}
