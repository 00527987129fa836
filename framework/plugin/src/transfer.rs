//! Kind `transfer`: where does the demonstrated canonical gripper pose belong on this
//! instance?

use crate::{CanonicalCloud, Field, PluginError};
use nalgebra::Point3;
use seeone_core::Pose;

/// The demonstrated grasp and the new instance, both in canonical space.
#[derive(Clone, Copy)]
pub struct TransferTask<'a> {
    /// H: the demonstrated gripper pose; translation in units of the canonical cube.
    pub demonstrated: &'a Pose,
    /// Metres per canonical unit of the demonstrated object.
    pub demonstrated_scale: f64,
    /// The field of the demonstrated object.
    pub demonstration: &'a dyn Field,
    /// The field of the new instance.
    pub instance: &'a dyn Field,
    /// The canonical cloud of the new instance.
    pub cloud: &'a CanonicalCloud,
    /// Metres per canonical unit of the new instance.
    pub instance_scale: f64,
    /// G: query points rigidly attached to the gripper, in the tool frame, metres.
    pub gripper_points: &'a [Point3<f64>],
}

impl TransferTask<'_> {
    /// Refuses what no transfer can work on, so that every implementation refuses alike.
    /// The fields are not asked for anything.
    ///
    /// # Errors
    /// [`PluginError::Input`] for an empty cloud, a cloud whose vectors differ in length,
    /// numbers that are not finite, scales that are not positive, or a gripper without
    /// query points.
    pub fn check(&self) -> Result<(), PluginError> {
        let cloud = self.cloud;
        if cloud.is_empty() {
            return refuse("the instance's cloud is empty");
        }
        if cloud.nocs.len() != cloud.len() || cloud.confidence.len() != cloud.len() {
            return refuse("the instance's cloud has points without canonical coordinates");
        }
        if self.gripper_points.is_empty() {
            return refuse("the gripper has no query points");
        }
        let finite = |p: &Point3<f64>| p.coords.iter().all(|v| v.is_finite());
        if !cloud.nocs.iter().chain(self.gripper_points).all(finite)
            || !cloud.confidence.iter().flatten().all(|c| c.is_finite())
        {
            return refuse("a point or confidence of the transfer task is not finite");
        }
        if !self.demonstrated.to_homogeneous().iter().all(|v| v.is_finite()) {
            return refuse("the demonstrated pose is not finite");
        }
        let scales = [self.demonstrated_scale, self.instance_scale];
        if !scales.iter().all(|s| s.is_finite() && *s > 0.0) {
            return refuse("a canonical cube's scale is not a positive number");
        }
        Ok(())
    }
}

fn refuse<T>(cause: &str) -> Result<T, PluginError> {
    Err(PluginError::Input(cause.to_owned()))
}

/// One candidate for the gripper pose on the new instance.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// H': translation in units of the canonical cube.
    pub pose: Pose,
    /// The loss it was ranked by (Eq. 9 plus prior), smaller is better.
    pub loss: f64,
    /// Confidence in `[0, 1]`.
    pub confidence: f64,
    /// Whether the hand shall be laid onto the observed surface between its fingers, which
    /// is known better than any predicted pose.
    pub lay_on_surface: bool,
    /// How it came about, in a few words.
    pub origin: String,
}

/// Says what no transfer may answer.
///
/// # Errors
/// A sentence about an empty list, or a candidate with a number that is not finite or out of
/// its range, or without an origin.
pub fn check_candidates(candidates: &[Candidate]) -> Result<(), String> {
    if candidates.is_empty() {
        return Err("there is no candidate".into());
    }
    let sound = |candidate: &Candidate| {
        candidate.pose.to_homogeneous().iter().all(|v| v.is_finite())
            && candidate.loss.is_finite()
            && (0.0..=1.0).contains(&candidate.confidence)
            && !candidate.origin.is_empty()
    };
    match candidates.iter().find(|candidate| !sound(candidate)) {
        None => Ok(()),
        Some(candidate) => Err(format!("a candidate is out of its range: {candidate:?}")),
    }
}

/// Demonstrated H -> ranked H' (method: Eq. 8 and 9).
pub trait Transfer: Send {
    /// Candidates, best first; never empty.
    ///
    /// # Errors
    /// [`PluginError::Input`] when the instance's cloud is empty or the fields differ in
    /// width.
    fn transfer(&self, task: &TransferTask) -> Result<Vec<Candidate>, PluginError>;
}
