//! Round objects: their turn about the canonical z axis is nobody's to know.
//!
//! A network that had to tell it would be taught chance. By convention a round object's
//! front is where the camera stands: training frames are turned so, and figures compare
//! with the nearest turn of the truth.

use crate::dataset::AlignedFrame;
use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use seeone_core::Similarity;

/// The frame turned so that the front, +y, faces the camera. Seen along its axis, a round
/// object has no side towards the camera, and stays as it is.
pub fn faced(frame: AlignedFrame) -> AlignedFrame {
    let camera = frame.alignment.transform_point(&Point3::from(frame.frame.info.camera.xyz_m));
    if camera.x.hypot(camera.y) > 1e-6 { turned(frame, camera.x.atan2(camera.y)) } else { frame }
}

/// The frame turned so that its canonical coordinates are nearest to `told`, one for each of
/// `rows` (nocs, in the unit cube).
pub fn nearest(frame: AlignedFrame, rows: &[usize], told: &[Point3<f64>]) -> AlignedFrame {
    let (mut sin, mut cos) = (0.0, 0.0);
    for (row, to) in rows.iter().zip(told) {
        let from = centred(&frame.frame.nocs[*row]);
        let to = to.coords - Vector3::repeat(0.5);
        sin += from.x * to.y - from.y * to.x;
        cos += from.x * to.x + from.y * to.y;
    }
    turned(frame, sin.atan2(cos))
}

fn turned(mut frame: AlignedFrame, angle: f64) -> AlignedFrame {
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle);
    for nocs in &mut frame.frame.nocs {
        let to = turn * centred(nocs) + Vector3::repeat(0.5);
        *nocs = to.map(|v| v as f32).into();
    }
    frame.alignment = Similarity::from_parts(Translation3::identity(), turn, 1.0) * frame.alignment;
    frame
}

fn centred(nocs: &[f32; 3]) -> Vector3<f64> {
    Vector3::from(nocs.map(f64::from)) - Vector3::repeat(0.5)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dataset::aligned;
    use seeone_core::Pose;
    use seeone_core::frames::{Frame, FrameInfo, Moment};
    use seeone_core::random::{generator, uniform};

    fn frame() -> AlignedFrame {
        let mut rng = generator(4, "round");
        let nocs: Vec<[f32; 3]> =
            (0..100).map(|_| [0, 1, 2].map(|_| uniform(&mut rng, 0.0, 1.0) as f32)).collect();
        let points = nocs.iter().map(|n| n.map(|v| 0.25 * v)).collect();
        let info = FrameInfo {
            object: 0,
            drop: 0,
            seconds: 1.0,
            moment: Moment::Resting,
            camera: (&Pose::translation(0.9, 0.3, 0.6)).into(),
            object_pose: (&Pose::identity()).into(),
        };
        aligned(Frame { info, points, nocs }).expect("a pose")
    }

    #[test]
    fn the_front_faces_the_camera_and_the_labels_follow() {
        let faced = faced(frame());
        let eye = faced.alignment.transform_point(&Point3::new(0.9, 0.3, 0.6));
        assert!(eye.x.abs() < 1e-9 && eye.y > 0.0);
        for (point, nocs) in faced.frame.points.iter().zip(&faced.frame.nocs) {
            let at = faced.alignment.transform_point(&Point3::from(point.map(f64::from)));
            assert!((at.coords - centred(nocs)).norm() < 1e-5);
        }
    }

    #[test]
    fn the_nearest_turn_is_found_again() {
        let truth = frame();
        let rows: Vec<usize> = (0..100).step_by(3).collect();
        let other = turned(truth.clone(), 2.1);
        let told: Vec<Point3<f64>> =
            rows.iter().map(|r| Point3::from(other.frame.nocs[*r].map(f64::from))).collect();
        let found = nearest(truth, &rows, &told);
        for (a, b) in found.frame.nocs.iter().zip(&other.frame.nocs) {
            assert!((centred(a) - centred(b)).norm() < 1e-5);
        }
    }
}
