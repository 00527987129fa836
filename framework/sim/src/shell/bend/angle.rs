//! The angle of a hinge and its gradient.

use nalgebra::Vector3;

/// A hinge away from rest.
#[derive(Clone, Copy, Debug)]
pub struct Bent {
    /// Sine and cosine, times one positive number, of the angle from rest.
    pub turn: (f64, f64),
    /// The gradient of the angle at the four corners.
    pub gradient: [Vector3<f64>; 4],
    /// Positive if the edge and both triangles have an extent; all else is nonsense if not.
    pub extent: f64,
}

/// The signed dihedral angle over the edge `[0]`-`[1]` with the opposite corners `[2]` and
/// `[3]`, from the angle whose (sine, cosine) is `rest`; 0 is flat (Bergou et al. 2006).
/// Without a branch, so that many can be worked out side by side.
#[inline(always)]
pub fn bent(points: &[Vector3<f64>; 4], rest: (f64, f64)) -> Bent {
    let [a, b, c, d] = points;
    let edge = b - a;
    let (ac, ad) = (c - a, d - a);
    let normal_c = edge.cross(&ac);
    let normal_d = ad.cross(&edge);
    let (cc, dd, ee) = (normal_c.dot(&normal_c), normal_d.dot(&normal_d), edge.dot(&edge));
    let length = ee.sqrt();
    // Sine and cosine times the lengths of both normals; turning them back by the rest
    // angle leaves a small angle that needs no wrapping.
    let (sin, cos) = (-length * normal_c.dot(&ad), normal_c.dot(&normal_d));
    let turn = (sin * rest.1 - cos * rest.0, cos * rest.1 + sin * rest.0);
    let at_c = normal_c * (-length / cc);
    let at_d = normal_d * (-length / dd);
    // The foot of each opposite corner on the edge shares its pull between the ends.
    let per_square = 1.0 / ee;
    let (along_c, along_d) = (ac.dot(&edge) * per_square, ad.dot(&edge) * per_square);
    let at_b = -(at_c * along_c + at_d * along_d);
    let at_a = -(at_c + at_d + at_b);
    Bent { turn, gradient: [at_a, at_b, at_c, at_d], extent: cc.min(dd).min(ee) }
}

/// Whether [`small_angle`] is good for this turn.
#[inline(always)]
pub fn is_small((sin, cos): (f64, f64)) -> bool {
    sin.abs() < 0.125 * cos
}

/// The arc tangent of a small turn, as nearly all are, by a short series: the library's
/// function would be a fifth of the whole simulation.
#[inline(always)]
pub fn small_angle((sin, cos): (f64, f64)) -> f64 {
    // The first term left out is below 1e-17 of the angle.
    const SERIES: [f64; 9] = [
        1.0,
        -1.0 / 3.0,
        1.0 / 5.0,
        -1.0 / 7.0,
        1.0 / 9.0,
        -1.0 / 11.0,
        1.0 / 13.0,
        -1.0 / 15.0,
        1.0 / 17.0,
    ];
    let x = sin / cos;
    let q = x * x;
    let [a, b, c, d, e, f, g, h, i] = SERIES;
    x * ((((((((i * q + h) * q + g) * q + f) * q + e) * q + d) * q + c) * q + b) * q + a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gradient_agrees_with_finite_differences() {
        let points = [
            Vector3::new(0.0, 0.1, 0.0),
            Vector3::new(1.0, 0.0, 0.2),
            Vector3::new(0.3, 0.9, 0.1),
            Vector3::new(0.6, -0.8, 0.4),
        ];
        let flat = (0.0, 1.0);
        let gradient = bent(&points, flat).gradient;
        let step = 1e-6;
        for corner in 0..4 {
            for axis in 0..3 {
                let at = |offset: f64| {
                    let mut moved = points;
                    moved[corner][axis] += offset;
                    let (sin, cos) = bent(&moved, flat).turn;
                    sin.atan2(cos)
                };
                let slope = (at(step) - at(-step)) / (2.0 * step);
                assert!((slope - gradient[corner][axis]).abs() < 1e-8, "{corner} {axis}");
            }
        }
    }

    #[test]
    fn the_series_is_the_arc_tangent() {
        for angle in [-0.1243, -0.1, -1e-9, 0.0, 0.06, 0.1243f64] {
            let turn = (1e-5 * angle.sin(), 1e-5 * angle.cos());
            assert!(is_small(turn));
            let found = small_angle(turn);
            assert!((found - angle).abs() <= 1e-13 * angle.abs(), "{found} for {angle}");
        }
        assert!([0.1245, -2.0, 3.1f64].iter().all(|a| !is_small(a.sin_cos())));
    }
}
