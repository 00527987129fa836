//! From the demonstrated grasp to grasps on this object.

use super::assignment::Assignment;
use super::bench::Bench;
use super::encode::Encoded;
use super::perceive::Perceived;
use super::schedule::leave;
use super::step::{Failed, Step};
use crate::plugins::Plugins;
use crate::transfer::{
    Held, Placement, brought_to_edge, edge_before_palm, gripper_points, laid_on_surface,
};
use bevy_ecs::prelude::*;
use seeone_core::Pose;
use seeone_plugin::{Candidate, PluginError, TransferTask};

/// A grasp on this object.
#[derive(Clone, Debug, PartialEq)]
pub struct Grasp {
    /// H' with its loss, confidence and origin.
    pub candidate: Candidate,
    /// T': the tool pose in `world`.
    pub tool: Pose,
    /// The object as it will then lie in the hand.
    pub held: Held,
    /// Observed points on which the position rests; zero when none was near.
    pub patch: usize,
    /// Root mean square residual of the placement there, metres.
    pub residual_m: f64,
}

/// The demonstrated grasp in canonical space, and what it became here.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct Transferred {
    /// The demonstrated object in the hand.
    pub demonstrated: Held,
    /// Grasps on this object, best first; never empty.
    pub grasps: Vec<Grasp>,
}

pub(super) fn transfer(
    mut commands: Commands,
    mut bench: NonSendMut<Bench>,
    runs: Query<(Entity, &Assignment, &Perceived, &Encoded), Without<Failed>>,
) {
    for (run, assignment, perceived, encoded) in &runs {
        let transferred = bench.step(Step::Transfer, |plugins| {
            transferred(plugins, assignment, perceived, encoded).map_err(|e| e.to_string())
        });
        leave(&mut commands, run, transferred);
    }
}

fn transferred(
    plugins: &Plugins,
    assignment: &Assignment,
    perceived: &Perceived,
    encoded: &Encoded,
) -> Result<Transferred, PluginError> {
    let alignment = plugins.alignment.as_ref();
    let shown = Placement::new(alignment, &perceived.demonstration)?;
    let here = Placement::new(alignment, &perceived.instance)?;
    let demonstrated = Held {
        tool: shown.pull_back(&assignment.skill.stages[0].gripper_pose)?,
        scale: shown.scale(),
    };
    let candidates = plugins.transfer.transfer(&TransferTask {
        demonstrated: &demonstrated.tool,
        demonstrated_scale: shown.scale(),
        demonstration: encoded.demonstration.as_ref(),
        instance: encoded.instance.as_ref(),
        cloud: &perceived.instance,
        instance_scale: here.scale(),
        gripper_points: &gripper_points(),
    })?;
    let taken = &assignment.skill.stages[0].gripper_pose;
    let shown_edge = edge_before_palm(taken, &perceived.demonstration.points);
    let mut grasps = Vec::with_capacity(candidates.len());
    for candidate in candidates {
        let (predicted, fit) = here.push_forward(&candidate.pose)?;
        if !finite(&candidate.pose) || !finite(&predicted) {
            return Err(PluginError::Internal("a candidate is not finite".into()));
        }
        let points = &perceived.instance.points;
        let laid = candidate.lay_on_surface.then(|| laid_on_surface(&predicted, points)).flatten();
        let laid = laid.map(|tool| match shown_edge {
            Some(edge) => brought_to_edge(&tool, points, edge),
            None => tool,
        });
        let tool = laid.unwrap_or(predicted);
        // What is in the hand is what the hand takes, laid on the surface or not.
        let held = Held { tool: fit.canonical(&tool), scale: here.scale() };
        let (patch, residual_m) = (fit.patch, fit.residual_m);
        grasps.push(Grasp { candidate, tool, held, patch, residual_m });
    }
    if grasps.is_empty() {
        return Err(PluginError::Internal("the transfer found no candidate".into()));
    }
    Ok(Transferred { demonstrated, grasps })
}

fn finite(pose: &Pose) -> bool {
    pose.to_homogeneous().iter().all(|v| v.is_finite())
}
