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
        // What is not finite makes a sum of zeros NaN. In four sums of vectors and without a branch a
        // point, since every cloud that crosses to a plugin is looked through.
        let zeros = |sums: [Vector3<f64>; 4], four: &[Point3<f64>]| {
            std::array::from_fn(|i| sums[i] + four[i].coords * 0.0)
        };
        let fours = points.chunks_exact(4);
        let rest = fours.remainder();
        let sums = fours.fold([Vector3::zeros(); 4], zeros);
        let rest = rest.iter().map(|p| p.coords * 0.0);
        if sums.into_iter().chain(rest).sum::<Vector3<f64>>() == Vector3::zeros() {
            return Ok(Self { points });
        }
        let finite = |p: &Point3<f64>| p.coords.iter().all(|v| v.is_finite());
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_point_that_is_not_finite_is_told_wherever_it_is() {
        for count in 0..10 {
            let points = vec![Point3::new(f64::MAX, f64::MIN, -0.0); count];
            let cloud = Cloud::new(points.clone());
            assert_eq!(cloud.map(|cloud| cloud.len()), Ok(count));
            for (place, axis) in (0..count).flat_map(|place| (0..3).map(move |axis| (place, axis)))
            {
                for broken in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
                    let mut points = points.clone();
                    points[place][axis] = broken;
                    assert_eq!(Cloud::new(points), Err(place), "{count} {axis} {broken}");
                }
            }
        }
    }
}
