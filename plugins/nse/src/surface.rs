//! Points drawn from a surface.

use nalgebra::Point3;
use seeone_core::TriangleMesh;
use seeone_core::random::uniform;

/// A triangle by its corners.
pub type Triangle = [Point3<f64>; 3];

/// The triangles of a mesh.
pub fn triangles(mesh: &TriangleMesh) -> Vec<Triangle> {
    (0..mesh.triangles().len()).map(|i| mesh.corners(i)).collect()
}

/// Draws points uniformly by area.
pub struct SurfaceSampler {
    triangles: Vec<Triangle>,
    /// Area of the triangles up to and including each.
    cumulative: Vec<f64>,
}

impl SurfaceSampler {
    /// Of these triangles; nothing when they have no area.
    pub fn new(triangles: Vec<Triangle>) -> Option<Self> {
        let cumulative: Vec<f64> = triangles
            .iter()
            .scan(0.0, |sum, [a, b, c]| {
                *sum += 0.5 * (b - a).cross(&(c - a)).norm();
                Some(*sum)
            })
            .collect();
        (cumulative.last().copied()? > 0.0).then_some(Self { triangles, cumulative })
    }

    /// One point.
    pub fn sample(&self, rng: &mut impl rand::Rng) -> Point3<f64> {
        let total = self.cumulative.last().copied().unwrap_or(0.0);
        let at = uniform(rng, 0.0, total);
        let index = self.cumulative.partition_point(|area| *area < at);
        let [a, b, c] = self.triangles[index.min(self.triangles.len() - 1)];
        // The square root makes the density uniform over the triangle.
        let (u, v) = (uniform(rng, 0.0, 1.0).sqrt(), uniform(rng, 0.0, 1.0));
        a + (b - a) * (u * (1.0 - v)) + (c - a) * (u * v)
    }

    /// `count` of them.
    pub fn samples(&self, count: usize, rng: &mut impl rand::Rng) -> Vec<Point3<f64>> {
        (0..count).map(|_| self.sample(rng)).collect()
    }
}
