//! The key poses of one way to take the object: all that were shown, or, for what lies where it
//! was to be but leans, those that set it right.

use super::assignment::Assignment;
use super::transfer::{Grasp, Transferred};
use crate::files::RelativeTo;
use crate::transfer::{Turn, carried, relation};
use bevy_ecs::prelude::*;
use nalgebra::UnitQuaternion;
use seeone_core::Pose;
use seeone_plugin::KeyPose;

/// The stage in which what leans is turned.
const RIGHTING: &str = "right";

/// Left on a run whose object lies where it was to be, but leans: the next try sets it right.
#[derive(Component, Clone, Copy, Debug, PartialEq)]
pub(super) struct Askew {
    /// What turns the object as it was shown into this one, in the frame of the result.
    pub lean: UnitQuaternion<f64>,
}

/// The skill's key poses for one grasp.
pub(super) fn shown(
    assignment: &Assignment,
    transferred: &Transferred,
    grasp: &Grasp,
    turn: &Turn,
) -> Vec<KeyPose> {
    let demonstration = &assignment.skill.demonstration;
    let taken = &assignment.skill.stages[0].gripper_pose;
    let pose = |relative_to: &RelativeTo, shown: &Pose| match relative_to {
        // Beside the object: where the demonstrated hand was, seen from its grasp.
        RelativeTo::Object => grasp.tool * taken.inverse() * shown,
        RelativeTo::Frame(name) => {
            let relation = relation(&demonstration.frames[name], shown, &transferred.demonstrated);
            carried(&assignment.frames[name], &relation, &grasp.held)
        }
    };
    let stages = assignment.skill.stages.iter();
    stages
        .map(|stage| {
            let at = pose(&stage.relative_to, &stage.gripper_pose) * turn.pose();
            stage.key_pose(at)
        })
        .collect()
}

/// Taken where it is and not lifted, turned back about the middle of the frame in which the
/// result was shown, and let go there as it was shown last. None where the skill shows no result.
pub(super) fn righting(
    assignment: &Assignment,
    grasp: &Grasp,
    turn: &Turn,
    askew: Askew,
) -> Option<Vec<KeyPose>> {
    let skill = &assignment.skill;
    let frame = &skill.result.as_ref()?.frame;
    let here = &assignment.frames[frame];
    let taken = grasp.tool * turn.pose();
    let last = skill.stages.last()?;
    let turned = here * askew.lean.inverse() * here.inverse() * taken;
    let most_n = skill.stages.iter().filter_map(|stage| stage.until_contact_n).reduce(f64::max);
    let first = KeyPose { lift_m: 0.0, retreat_m: 0.0, ..skill.stages[0].key_pose(taken) };
    let right = KeyPose {
        stage: RIGHTING.into(),
        pose: turned,
        approach_m: 0.0,
        until_contact_n: most_n,
        gripper: None,
        ..first.clone()
    };
    Some(vec![first, right, last.key_pose(turned)])
}
