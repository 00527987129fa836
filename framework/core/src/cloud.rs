//! Point clouds.

use nalgebra::{Point3, Vector3};

/// Points in metres, in the frame that the owner names (`world` unless said otherwise).
/// Every coordinate is finite; a cloud may be empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cloud {
    points: Vec<Point3<f64>>,
}

impl Cloud {
    /// A cloud of finite points.
    ///
    /// # Errors
    /// The index of the first point that is not finite.
    pub fn new(points: Vec<Point3<f64>>) -> Result<Self, usize> {
        let finite = |p: &Point3<f64>| p.x.is_finite() & p.y.is_finite() & p.z.is_finite();
        // Without a branch a point, so that whole clouds are looked through at once.
        if points.iter().fold(true, |all, p| all & finite(p)) {
            return Ok(Self { points });
        }
        Err(points.iter().position(|p| !finite(p)).unwrap_or_default())
    }

    /// The points.
    pub fn points(&self) -> &[Point3<f64>] {
        &self.points
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there is nothing in it.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The mean of the points; the origin for an empty cloud.
    pub fn centroid(&self) -> Point3<f64> {
        let sum: Vector3<f64> = self.points.iter().map(|p| p.coords).sum();
        Point3::from(sum / self.points.len().max(1) as f64)
    }
}
