//! What was seen of the object, as the planner is told of it.

use nalgebra::Point3;
use seeone_core::{Cloud, extremes};
use seeone_plugin::{GripperCommand, KeyPose};

/// Directions in which the outermost points are looked for.
const DIRECTIONS: usize = 128;

/// The outermost points of a cloud, in `world`: they span its convex hull, what the camera does
/// not see left out.
#[derive(Clone, Debug, PartialEq)]
pub struct Hull(Vec<Point3<f64>>);

impl Hull {
    /// Of what was seen before anything moves.
    pub fn of(cloud: &Cloud) -> Self {
        Self(extremes(cloud.points(), DIRECTIONS))
    }

    /// The points in the closed hand's tool frame as it takes the object where it first closes, metres;
    /// none where it never does.
    pub fn in_the_hand(&self, key_poses: &[KeyPose]) -> Vec<Point3<f64>> {
        let closes = |key: &&KeyPose| matches!(key.gripper, Some(GripperCommand::Close { .. }));
        let taken = key_poses.iter().find(closes).map(|key| key.pose.inverse());
        taken.map_or_else(Vec::new, |pose| self.0.iter().map(|point| pose * point).collect())
    }
}
