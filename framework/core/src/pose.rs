//! Poses as the files write them, and the checked poses that everything else uses.

use nalgebra::{Isometry3, Quaternion, Similarity3, Translation3, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

/// A rigid transform: metres and a unit quaternion.
pub type Pose = Isometry3<f64>;

/// A rigid transform with a uniform scale, e.g. canonical cube -> metres.
pub type Similarity = Similarity3<f64>;

/// How far a written quaternion's length may be from one before it is refused.
const QUATERNION_TOLERANCE: f64 = 1e-3;

/// A pose as files write it: `{ xyz_m = [..], quat_xyzw = [..] }`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PoseFields {
    /// Position in metres.
    pub xyz_m: [f64; 3],
    /// Orientation as a quaternion, scalar last.
    pub quat_xyzw: [f64; 4],
}

impl PoseFields {
    /// The checked pose.
    ///
    /// # Errors
    /// A sentence naming the fault when a number is not finite or the quaternion is not
    /// of unit length within 0.1 %.
    pub fn resolve(&self) -> Result<Pose, String> {
        if !self.xyz_m.iter().chain(&self.quat_xyzw).all(|v| v.is_finite()) {
            return Err("a pose must be finite".into());
        }
        let [x, y, z, w] = self.quat_xyzw;
        let quaternion = Quaternion::new(w, x, y, z);
        let length = quaternion.norm();
        if (length - 1.0).abs() > QUATERNION_TOLERANCE {
            return Err(format!("the quaternion has length {length:.4}, not 1"));
        }
        let [x, y, z] = self.xyz_m;
        Ok(Pose::from_parts(
            Translation3::new(x, y, z),
            UnitQuaternion::from_quaternion(quaternion),
        ))
    }
}

impl From<&Pose> for PoseFields {
    fn from(pose: &Pose) -> Self {
        let q = pose.rotation.coords;
        Self { xyz_m: pose.translation.vector.into(), quat_xyzw: [q.x, q.y, q.z, q.w] }
    }
}

/// Position error in metres and rotation error in radians between two poses.
pub fn difference(a: &Pose, b: &Pose) -> (f64, f64) {
    let distance = (a.translation.vector - b.translation.vector).norm();
    (distance, a.rotation.angle_to(&b.rotation))
}

/// A rotation whose third column is `z` and whose second column is as near to `y` as
/// orthogonality allows: the tool frame's approach and closing directions.
pub fn rotation_from_approach(z: &Vector3<f64>, y: &Vector3<f64>) -> UnitQuaternion<f64> {
    let z = z.normalize();
    let x = y.cross(&z).normalize();
    let y = z.cross(&x);
    let matrix = nalgebra::Matrix3::from_columns(&[x, y, z]);
    UnitQuaternion::from_rotation_matrix(&nalgebra::Rotation3::from_matrix_unchecked(matrix))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pose_survives_writing_and_reading() {
        let pose = Pose::new(Vector3::new(0.1, -0.2, 0.3), Vector3::new(0.4, 0.5, -0.6));
        let back = PoseFields::from(&pose).resolve().expect("valid");
        let (distance, angle) = difference(&pose, &back);
        assert!(distance < 1e-12 && angle < 1e-7);
    }

    #[test]
    fn refuses_what_is_no_pose() {
        let long = PoseFields { xyz_m: [0.0; 3], quat_xyzw: [0.0, 0.0, 0.0, 1.1] };
        assert!(long.resolve().is_err());
        let nan = PoseFields { xyz_m: [f64::NAN, 0.0, 0.0], quat_xyzw: [0.0, 0.0, 0.0, 1.0] };
        assert!(nan.resolve().is_err());
    }

    #[test]
    fn approach_and_closing_directions_become_columns() {
        let r = rotation_from_approach(&Vector3::new(0.0, -2.0, 0.0), &Vector3::z());
        assert!((r * Vector3::z() + Vector3::y()).norm() < 1e-12);
        assert!((r * Vector3::y() - Vector3::z()).norm() < 1e-12);
    }
}
