//! The nearest points of two segments.

use nalgebra::{Point3, Vector3};

/// Segments shorter than the root of this are points, square metres.
const POINT: f64 = 1e-18;

/// A segment by its middle and half its extent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Segment {
    pub(crate) middle: Point3<f64>,
    pub(crate) half: Vector3<f64>,
}

impl Segment {
    fn at(&self, share: f64) -> Point3<f64> {
        self.middle + self.half * share
    }

    /// Where on the segment, in -1..=1, is nearest to `point`.
    fn nearest_to(&self, point: &Point3<f64>) -> f64 {
        let square = self.half.norm_squared();
        if square < POINT {
            0.0
        } else {
            (self.half.dot(&(point - self.middle)) / square).clamp(-1.0, 1.0)
        }
    }

    /// The nearest points of this segment and another; of parallel ones, any pair of them.
    pub(crate) fn nearest(&self, other: &Self) -> (Point3<f64>, Point3<f64>) {
        let across = self.half.dot(&other.half);
        let (square, other_square) = (self.half.norm_squared(), other.half.norm_squared());
        let determinant = square * other_square - across * across;
        // Where the lines are nearest, moved into the first segment; the second then has its
        // nearest point to that, and the first once more, since both were clamped.
        let share = if determinant > 1e-12 * square * other_square {
            let between = other.middle - self.middle;
            let (a, b) = (self.half.dot(&between), other.half.dot(&between));
            ((a * other_square - b * across) / determinant).clamp(-1.0, 1.0)
        } else {
            self.nearest_to(&other.middle)
        };
        let on_other = other.at(other.nearest_to(&self.at(share)));
        let on_self = self.at(self.nearest_to(&on_other));
        (on_self, on_other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_core::random::{direction, generator, uniform};

    /// The smallest distance by search over a grid of both.
    fn searched(a: &Segment, b: &Segment) -> f64 {
        let shares = || (-60..=60).map(|k| f64::from(k) / 60.0);
        shares()
            .flat_map(|s| shares().map(move |t| (s, t)))
            .map(|(s, t)| (a.at(s) - b.at(t)).norm())
            .fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn nothing_on_the_segments_is_nearer() {
        let mut rng = generator(5, "segments");
        for case in 0..300 {
            let mut draw = || Segment {
                middle: (direction(&mut rng) * 0.5).into(),
                half: direction(&mut rng) * uniform(&mut rng, 0.0, 0.6),
            };
            let (a, mut b) = (draw(), draw());
            match case % 10 {
                0 => b.half = a.half * 0.5,
                1 => b.half = Vector3::zeros(),
                _ => {}
            }
            let (p, q) = a.nearest(&b);
            let (found, least) = ((p - q).norm(), searched(&a, &b));
            assert!((found - 1e-9..found + 0.02).contains(&least), "{found} {least}");
        }
    }
}
