//! Poses and intrinsics as files write them.

use super::exactly::Exactly;
use schemars::JsonSchema;
use seeone_core::Intrinsics;
use seeone_core::pose::PoseFields;
use serde::Deserialize;

/// A pose in `world`: position, and orientation as a unit quaternion.
#[derive(Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "pose")]
pub(super) struct RawPose {
    /// Position, metres.
    xyz_m: Exactly<f64, 3>,
    /// Orientation as a quaternion of unit length, scalar last.
    quat_xyzw: Exactly<f64, 4>,
}

impl From<&RawPose> for PoseFields {
    fn from(raw: &RawPose) -> Self {
        Self { xyz_m: raw.xyz_m.0, quat_xyzw: raw.quat_xyzw.0 }
    }
}

/// A pinhole camera without distortion, pixels.
#[derive(Clone, Copy, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "intrinsics")]
pub(super) struct RawIntrinsics {
    /// Width of the image.
    width: usize,
    /// Height of the image.
    height: usize,
    /// Focal length along x, positive.
    fx: f64,
    /// Focal length along y, positive.
    fy: f64,
    /// Principal point, x.
    cx: f64,
    /// Principal point, y.
    cy: f64,
}

impl From<RawIntrinsics> for Intrinsics {
    fn from(raw: RawIntrinsics) -> Self {
        let RawIntrinsics { width, height, fx, fy, cx, cy } = raw;
        Self { width, height, fx, fy, cx, cy }
    }
}
