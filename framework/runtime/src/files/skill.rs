//! A skill: one demonstration of one manipulation.

use nalgebra::Point3;
use seeone_core::Pose;
use seeone_plugin::{GripperCommand, KeyPose, Kind, Measure};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// What a stage's gripper pose moves with.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum RelativeTo {
    /// With the object: the pose goes through the canonical state (method: Eq. 6 to 9).
    Object,
    /// With a frame of the scene, e.g. `head`.
    Frame(String),
}

/// A gripper pose of the demonstration and what happens around it.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// Its name, unique in the skill.
    pub name: String,
    /// What the pose moves with.
    pub relative_to: RelativeTo,
    /// The demonstrated tool frame (TCP) in `world`.
    pub gripper_pose: Pose,
    /// Straight approach along the tool's z, metres.
    pub approach_m: f64,
    /// Opening of the fingers while approaching, metres.
    pub opening_m: f64,
    /// The line to the pose ends where the load at the wrist has changed by this, newtons:
    /// the pose is as far as it may go. `None` goes all the way whatever it feels.
    pub until_contact_n: Option<f64>,
    /// What the gripper does at the pose.
    pub gripper: Option<GripperCommand>,
    /// Straight retreat against the tool's z, metres.
    pub retreat_m: f64,
    /// Straight lift along the world's z, metres.
    pub lift_m: f64,
    /// By how much the grasp may be turned about the tool's closing axis without spoiling
    /// it, degrees either way; zero for not at all.
    pub turn_about_closing_deg: f64,
    /// Whether the pose is reached by the motion that was shown from the pose before it, from wherever
    /// the hand then is: where contact has ended a line early, the two are not the same.
    pub onward: bool,
}

/// What was seen when the skill was shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Demonstration {
    /// The PLY file of the object's points in `world`, metres, before the first stage.
    pub cloud: PathBuf,
    /// Where the camera stood in `world`, metres.
    pub camera_position: Point3<f64>,
    /// Poses of the scene's frames in `world`.
    pub frames: BTreeMap<String, Pose>,
}

/// How the object lay when the demonstration was over, and how nearly another has to lie so.
#[derive(Clone, Debug, PartialEq)]
pub struct ShownResult {
    /// The PLY file of the object's points in `world`, metres, after the last stage, seen from
    /// where the demonstration was seen.
    pub cloud: PathBuf,
    /// The frame of the demonstration in which it lies.
    pub frame: String,
    /// How far from there another object may be, metres.
    pub within_m: f64,
    /// By how much its up axis may be turned against how it was, degrees.
    pub within_deg: f64,
}

/// A skill. One that was read from a file has at least one stage, the first of which moves
/// with the object; names are unique; every frame a stage names is in the demonstration.
#[derive(Clone, Debug, PartialEq)]
pub struct Skill {
    /// Its name.
    pub name: String,
    /// The category of objects it is for.
    pub category: String,
    /// What it does, in a sentence.
    pub summary: String,
    /// What was seen.
    pub demonstration: Demonstration,
    /// The key poses, in order.
    pub stages: Vec<Stage>,
    /// Names of plugins, where the skill asks for one.
    pub methods: BTreeMap<Kind, String>,
    /// What the robot looks for itself when it is done, if anything.
    pub result: Option<ShownResult>,
    /// What counts as success.
    pub measure: Measure,
}

impl Skill {
    /// The frames that a scene must have: those that stages move with, the one in which the result
    /// is looked at, and the one by which success is measured. A frame may come more than once.
    pub fn frames(&self) -> impl Iterator<Item = &str> {
        let measured = match &self.measure {
            Measure::Worn { .. } => "head",
            Measure::Hung => "hook",
            Measure::Held { frame, .. } => frame,
        };
        let moved_with = self.stages.iter().filter_map(|stage| match &stage.relative_to {
            RelativeTo::Frame(name) => Some(name.as_str()),
            RelativeTo::Object => None,
        });
        let looked_at = self.result.iter().map(|result| result.frame.as_str());
        moved_with.chain(looked_at).chain([measured])
    }
}

impl Stage {
    /// A pose that is passed through: nothing is gripped, felt for or backed away from.
    pub fn through(name: &str, relative_to: RelativeTo, gripper_pose: Pose) -> Self {
        Self {
            name: name.to_owned(),
            relative_to,
            gripper_pose,
            approach_m: 0.0,
            opening_m: Self::OPENING_M,
            until_contact_n: None,
            gripper: None,
            retreat_m: 0.0,
            lift_m: 0.0,
            turn_about_closing_deg: 0.0,
            onward: false,
        }
    }

    /// What a planner is asked for, with the tool frame at `pose` in `world` instead of where it
    /// was shown.
    pub fn key_pose(&self, pose: Pose) -> KeyPose {
        KeyPose {
            stage: self.name.clone(),
            pose,
            approach_m: self.approach_m,
            opening_m: self.opening_m,
            until_contact_n: self.until_contact_n,
            gripper: self.gripper,
            retreat_m: self.retreat_m,
            lift_m: self.lift_m,
        }
    }

    /// Opening while approaching when the file does not say it, metres.
    pub const OPENING_M: f64 = 0.03;
    /// Turn about the closing axis when the file does not say it, degrees.
    pub const TURN_ABOUT_CLOSING_DEG: f64 = 90.0;
}
