//! A capsule and the distance from it.

use nalgebra::{Point3, Vector3};

/// All points within `radius` of a segment on the z axis; a ball where the segment has no
/// length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    /// Half of the segment's length, metres.
    pub half_length: f64,
    /// Metres, positive.
    pub radius: f64,
}

impl Capsule {
    /// Distance of `p` from the surface, negative inside, and the outward normal at the
    /// nearest surface point.
    #[inline]
    pub fn signed_distance(&self, p: &Point3<f64>) -> (f64, Vector3<f64>) {
        let along = p.z.clamp(-self.half_length, self.half_length);
        let away = Vector3::new(p.x, p.y, p.z - along);
        let distance = away.norm();
        // On the axis every side is as near as any other.
        let normal = if distance > 0.0 { away / distance } else { Vector3::x() };
        (distance - self.radius, normal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_from_side_end_and_axis() {
        let peg = Capsule { half_length: 0.04, radius: 0.006 };
        let near = |p: [f64; 3], distance: f64, normal: [f64; 3]| {
            let (found, direction) = peg.signed_distance(&p.into());
            assert!((found - distance).abs() < 1e-12, "{found} for {distance}");
            assert!((direction - Vector3::from(normal)).norm() < 1e-12);
        };
        near([0.0, 0.010, 0.03], 0.004, [0.0, 1.0, 0.0]);
        near([0.0, 0.0, -0.05], 0.004, [0.0, 0.0, -1.0]);
        near(
            [0.003, 0.0, 0.041],
            1e-5f64.sqrt() - 0.006,
            [0.003, 0.0, 0.001].map(|c: f64| c / 1e-5f64.sqrt()),
        );
        near([0.0, 0.0, 0.0], -0.006, [1.0, 0.0, 0.0]);
    }
}
