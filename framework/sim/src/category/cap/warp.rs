//! The warp of the hem: a fixed number of hem vertices carries a brim of any angle.

/// A smooth turn of the angles about the crown's axis, `theta(u) = u + a sin u + b sin 2u`:
/// odd, so that left and right agree, and still at the front (0) and at the back (pi).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Warp {
    a: f64,
    b: f64,
}

impl Warp {
    /// No warp.
    pub const NONE: Self = Self { a: 0.0, b: 0.0 };

    /// The warp that carries the angle `u` to `theta`.
    pub fn through([u, theta]: [f64; 2]) -> Self {
        Self { a: (theta - u) / u.sin(), b: 0.0 }
    }

    /// The warp that carries each of two angles `u` to its `theta`; the angles differ and
    /// lie between 0 and pi.
    pub fn through_both([u, theta]: [f64; 2], [v, phi]: [f64; 2]) -> Self {
        let ([s, s2], [t, t2]) = ([u.sin(), (2.0 * u).sin()], [v.sin(), (2.0 * v).sin()]);
        let determinant = s * t2 - s2 * t;
        Self {
            a: ((theta - u) * t2 - (phi - v) * s2) / determinant,
            b: ((phi - v) * s - (theta - u) * t) / determinant,
        }
    }

    /// Where `part` of the warp takes the angle `u`, radians.
    pub fn angle(self, u: f64, part: f64) -> f64 {
        u + part * (self.a * u.sin() + self.b * (2.0 * u).sin())
    }

    /// A bound from below on how far apart angles stay, relative to before.
    pub fn least_spacing(self) -> f64 {
        1.0 - self.a.abs() - 2.0 * self.b.abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn it_goes_through_its_angles_and_keeps_front_and_back() {
        let warp = Warp::through_both([1.14, 1.02], [2.7, 2.75]);
        assert!(warp.least_spacing() > 0.3);
        for (u, theta) in [(0.0, 0.0), (1.14, 1.02), (2.7, 2.75), (PI, PI), (-1.14, -1.02)] {
            assert!((warp.angle(u, 1.0) - theta).abs() < 1e-12);
            assert!((warp.angle(u, 0.0) - u).abs() < 1e-12);
        }
        assert!((Warp::through([1.4, 1.6]).angle(1.4, 1.0) - 1.6).abs() < 1e-12);
    }
}
