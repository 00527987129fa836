//! A triangle as a plane with three sides, and what is above it.

use nalgebra::{Point3, Vector3};

/// Where a point is above a triangle.
pub struct Above {
    /// Barycentric coordinates of its foot.
    pub weights: [f64; 3],
    /// The triangle's unit normal.
    pub normal: Vector3<f64>,
    /// Along the normal, metres.
    pub height: f64,
}

impl Above {
    /// Whether the foot is inside the triangle, or outside by no more than `overlap`.
    pub fn is_over(&self, overlap: f64) -> bool {
        self.weights.iter().all(|w| *w >= -overlap)
    }
}

/// A triangle with area.
pub struct Facet {
    origin: Point3<f64>,
    sides: [Vector3<f64>; 2],
    /// The normal, as long as twice the area.
    normal: Vector3<f64>,
    per_squared: f64,
    per_length: f64,
}

impl Facet {
    /// Nothing when the corners lie on one line.
    #[inline]
    pub fn new([a, b, c]: &[Point3<f64>; 3]) -> Option<Self> {
        let sides = [b - a, c - a];
        let normal = sides[0].cross(&sides[1]);
        let squared = normal.norm_squared();
        (squared > 0.0).then(|| {
            let per_squared = 1.0 / squared;
            Self { origin: *a, sides, normal, per_squared, per_length: per_squared.sqrt() }
        })
    }

    /// Where `p` is.
    #[inline]
    pub fn above(&self, p: &Point3<f64>) -> Above {
        let [ab, ac] = &self.sides;
        let ap = p - self.origin;
        let v = ap.cross(ac).dot(&self.normal) * self.per_squared;
        let w = ab.cross(&ap).dot(&self.normal) * self.per_squared;
        Above {
            weights: [1.0 - v - w, v, w],
            normal: self.normal * self.per_length,
            height: ap.dot(&self.normal) * self.per_length,
        }
    }

    /// A distance to the triangle that the true one is not below, metres: the height, or how
    /// far the foot is beyond the line of a side.
    pub fn distance(&self, above: &Above) -> f64 {
        let [ab, ac] = &self.sides;
        let opposite = [ac - ab, *ac, *ab];
        let beyond = opposite.iter().zip(above.weights).map(|(side, weight)| {
            // The altitude on a side is twice the area over its length.
            -weight / (self.per_length * side.norm())
        });
        beyond.fold(above.height.abs(), f64::max)
    }
}
