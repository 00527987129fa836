//! The checked robot and its kinematics.

use super::{GripperModel, Joint, RobotDescription, RobotOptions, Solid, tessellate::tessellate};
use crate::{Pose, TriangleMesh};
use nalgebra::{Matrix6xX, Translation3, Vector3};
use std::sync::Arc;

/// One rigid part of the arm: the base, or what is behind a joint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Link {
    /// What it may not put into something else; poses in the link's frame.
    pub collision: Vec<Solid>,
    /// What it looks like; poses in the link's frame.
    pub visual: Vec<Solid>,
}

/// A serial arm of revolute joints with a two-finger gripper. Made by
/// [`RobotModel::from_urdf`] alone, so whatever holds one may rely on its checks.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotModel {
    pub(super) name: String,
    pub(super) base: Pose,
    pub(super) joints: Vec<Joint>,
    pub(super) links: Vec<Link>,
    pub(super) tool: Pose,
    pub(super) home: Vec<f64>,
    pub(super) acceleration: f64,
    pub(super) jerk: f64,
    pub(super) unchecked_pairs: Vec<[String; 2]>,
    pub(super) gripper: GripperModel,
    /// The text that it was read from, shared by its copies.
    pub(super) urdf: Arc<str>,
    pub(super) tool_link: String,
}

impl RobotModel {
    /// The robot's name in the URDF.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Pose of the base link in `world`.
    pub fn base(&self) -> &Pose {
        &self.base
    }

    /// The joints, base first; at least one.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// The arm's links without the gripper: the base, then one behind each joint.
    pub fn links(&self) -> &[Link] {
        &self.links
    }

    /// Pose of the tool frame (TCP) of the closed hand in the last link.
    pub fn tool(&self) -> &Pose {
        &self.tool
    }

    /// Pose of the tool frame in the last link with the pads `opening_m` apart: between the pads,
    /// which come forward as they close. [`Self::tool`] is that of the closed hand.
    pub fn tool_at(&self, opening_m: f64) -> Pose {
        let gripper = &self.gripper;
        let back = gripper.reach_m(opening_m) - gripper.reach_m(0.0);
        self.tool * Translation3::new(0.0, 0.0, back)
    }

    /// Where the arm waits, radians; within the limits.
    pub fn home(&self) -> &[f64] {
        &self.home
    }

    /// Largest acceleration of every joint, radians a second squared.
    pub fn acceleration(&self) -> f64 {
        self.acceleration
    }

    /// Largest jerk of every joint, radians a second cubed.
    pub fn jerk(&self) -> f64 {
        self.jerk
    }

    /// Pairs of URDF links that always touch or never can, so that nobody needs to check them.
    pub fn unchecked_pairs(&self) -> &[[String; 2]] {
        &self.unchecked_pairs
    }

    /// What it was made of, for whoever has to make the same model elsewhere.
    pub fn description(&self) -> RobotDescription {
        RobotDescription {
            urdf: self.urdf.to_string(),
            options: RobotOptions {
                base: self.base,
                tool_link: self.tool_link.clone(),
                home: Some(self.home.clone()),
                acceleration: self.acceleration,
                jerk: self.jerk,
                unchecked_pairs: self.unchecked_pairs.clone(),
                gripper: self.gripper.options().clone(),
            },
        }
    }

    /// The gripper.
    pub fn gripper(&self) -> &GripperModel {
        &self.gripper
    }

    /// Whether `q` has one finite value within the limits for each joint.
    pub fn within_limits(&self, q: &[f64]) -> bool {
        q.len() == self.joints.len() && self.joints.iter().zip(q).all(|(j, q)| j.allows(*q))
    }

    /// Poses of the links in `world` at joint positions `q`; as many as [`Self::links`].
    ///
    /// # Panics
    /// When `q` has not one value a joint.
    pub fn forward(&self, q: &[f64]) -> Vec<Pose> {
        let mut poses = Vec::with_capacity(self.links.len());
        self.forward_into(q, &mut poses);
        poses
    }

    /// As [`Self::forward`], into a vector whose room is used again.
    ///
    /// # Panics
    /// When `q` has not one value a joint.
    pub fn forward_into(&self, q: &[f64], poses: &mut Vec<Pose>) {
        assert_eq!(q.len(), self.joints.len(), "one position a joint");
        poses.clear();
        let mut pose = self.base;
        poses.push(pose);
        for (joint, position) in self.joints.iter().zip(q) {
            pose *= joint.transform(*position);
            poses.push(pose);
        }
    }

    /// Pose of the tool frame in `world` at joint positions `q`.
    ///
    /// # Panics
    /// When `q` has not one value a joint.
    pub fn tool_pose(&self, q: &[f64]) -> Pose {
        assert_eq!(q.len(), self.joints.len(), "one position a joint");
        let chain = self.joints.iter().zip(q);
        chain.fold(self.base, |pose, (joint, position)| pose * joint.transform(*position))
            * self.tool
    }

    /// The geometric Jacobian at `q`: rows 0..3 are the tool point's velocity in `world`
    /// (m/s), rows 3..6 its angular velocity (rad/s), one column a joint (rad/s).
    ///
    /// # Panics
    /// When `q` has not one value a joint.
    pub fn jacobian(&self, q: &[f64]) -> Matrix6xX<f64> {
        let mut jacobian = Matrix6xX::zeros(self.joints.len());
        self.jacobian_into(&self.forward(q), &mut jacobian);
        jacobian
    }

    /// As [`Self::jacobian`], from the poses of the links ([`Self::forward`]) and into a
    /// matrix of one column a joint.
    ///
    /// # Panics
    /// When there is not one pose a link or one column a joint.
    pub fn jacobian_into(&self, links: &[Pose], jacobian: &mut Matrix6xX<f64>) {
        assert_eq!(links.len(), self.links.len(), "one pose a link");
        assert_eq!(jacobian.ncols(), self.joints.len(), "one column a joint");
        let tip = (links[self.joints.len()] * self.tool).translation.vector;
        for (i, joint) in self.joints.iter().enumerate() {
            // A turn about the axis leaves the axis itself in place, so the link behind
            // the joint gives its direction and a point on it.
            let axis: Vector3<f64> = links[i + 1] * joint.axis.into_inner();
            let arm = tip - links[i + 1].translation.vector;
            jacobian.fixed_view_mut::<3, 1>(0, i).copy_from(&axis.cross(&arm));
            jacobian.fixed_view_mut::<3, 1>(3, i).copy_from(&axis);
        }
    }

    /// What the robot looks like at joint positions `q` with the pads `opening_m` apart:
    /// one mesh a body, vertices in `world`.
    ///
    /// # Panics
    /// When `q` has not one value a joint.
    pub fn meshes(&self, q: &[f64], opening_m: f64) -> Vec<TriangleMesh> {
        let poses = self.forward(q);
        let arm = self.links.iter().zip(&poses).flat_map(|(link, pose)| {
            link.visual.iter().map(move |solid| tessellate(&solid.shape, &(pose * solid.pose)))
        });
        let last = poses[self.joints.len()];
        let hand = self.gripper.visual(opening_m).into_iter();
        arm.chain(hand.map(|solid| tessellate(&solid.shape, &(last * solid.pose)))).collect()
    }
}
