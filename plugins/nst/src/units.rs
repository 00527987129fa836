//! The frames and units in which the networks see clouds.

use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use seeone_core::Pose;

/// Network units in a metre.
pub const PER_METRE: f64 = 10.0;
/// Network units in a canonical unit: about as large as an object is in metres.
pub const PER_CANONICAL: f64 = 2.7;

/// `world` -> the frame in which the coarse network sees a cloud: the origin below its
/// centroid on the table, z up, turned so that the camera stands towards -y. A camera
/// straight above leaves the heading as it is in `world`.
pub fn camera_frame(points: &[Vector3<f64>], camera: &Point3<f64>) -> Pose {
    let centroid = points.iter().sum::<Vector3<f64>>() / points.len().max(1) as f64;
    let towards = camera.coords - centroid;
    let heading = if towards.xy().norm() > 1e-6 { towards.y.atan2(towards.x) } else { 0.0 };
    let turn = -std::f64::consts::FRAC_PI_2 - heading;
    let rotation = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turn);
    rotation * Translation3::new(-centroid.x, -centroid.y, 0.0)
}

/// Centred canonical coordinates as the coarse network tells them: `2 |x|`, `y + 0.5`,
/// `z + 0.5`, all in `[0, 1]`.
pub fn fold(p: &Vector3<f64>) -> [f32; 3] {
    [(2.0 * p.x.abs()) as f32, (p.y + 0.5) as f32, (p.z + 0.5) as f32]
}

/// The inverse of [`fold`], up to the side: `[|x|, y, z]`.
pub fn unfold(values: &[f64; 3]) -> Vector3<f64> {
    Vector3::new(0.5 * values[0], values[1] - 0.5, values[2] - 0.5)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_camera_stands_towards_minus_y() {
        let points = [Vector3::new(0.5, 0.2, 0.05), Vector3::new(0.7, 0.4, 0.15)];
        for camera in [Point3::new(1.5, 0.3, 0.8), Point3::new(-0.3, -0.9, 0.6)] {
            let frame = camera_frame(&points, &camera);
            let seen = frame * camera;
            assert!(seen.x.abs() < 1e-12 && seen.y < 0.0 && (seen.z - camera.z).abs() < 1e-12);
            let middle = frame * Point3::new(0.6, 0.3, 0.0);
            assert!(middle.coords.norm() < 1e-12);
        }
    }

    #[test]
    fn folding_forgets_the_side_alone() {
        let p = Vector3::new(-0.3, 0.2, -0.1);
        let back = unfold(&fold(&p).map(f64::from));
        assert!((back - Vector3::new(0.3, 0.2, -0.1)).norm() < 1e-7);
    }
}
