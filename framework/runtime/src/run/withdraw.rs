//! After a run that failed: the hand opens and goes back to where the robot waits, out of the
//! camera's view, so that the next run can look.

use super::act::Acted;
use super::assignment::Assignment;
use super::bench::Bench;
use super::cancel::Cancel;
use super::plan::RETREAT_SHARES;
use super::step::{Failed, Step};
use crate::plugins::Plugins;
use bevy_ecs::prelude::*;
use seeone_core::Pose;
use seeone_plugin::{GripperCommand, KeyPose, MotionOutcome, MotionTask, RobotSample};

/// How far the hand draws back from where it failed, metres, before it is free to go anywhere.
const RETREAT_M: f64 = 0.15;

/// It comes home by a line of so many metres: key poses that nothing lies between are joined by a
/// straight line, and home is not to be on one.
const HOMING_M: f64 = 0.01;

/// On a run: one that failed, or a try that did, came before it.
#[derive(Component, Clone, Copy, Debug)]
pub struct Withdraw;

/// Runs that begin by going back.
type Returning = (With<Withdraw>, Without<Failed>);

pub(super) fn withdraw(
    mut commands: Commands,
    mut bench: NonSendMut<Bench>,
    mut runs: Query<(Entity, &Assignment, Option<&mut Acted>), Returning>,
) {
    for (run, assignment, before) in &mut runs {
        if assignment.dry_run {
            continue;
        }
        let cancel = bench.cancel().clone();
        let mut acted = before.map(|mut acted| std::mem::take(&mut *acted)).unwrap_or_default();
        let withdrawn = bench
            .step(Step::Withdraw, |plugins| withdrawn(plugins, assignment, &cancel, &mut acted));
        commands.entity(run).insert(acted).remove::<Withdraw>();
        if let Err(failed) = withdrawn {
            commands.entity(run).insert(failed);
        }
    }
}

/// Opens the hand and takes it back to where the robot waits; what the robot does on its way is
/// noted in `acted`.
pub(super) fn withdrawn(
    plugins: &mut Plugins,
    assignment: &Assignment,
    cancel: &Cancel,
    acted: &mut Acted,
) -> Result<(), String> {
    let model = &assignment.robot;
    let start = plugins.robot.state().map_err(|e| e.to_string())?.joints;
    let opening_m = assignment.skill.stages[0].opening_m;
    let at = |pose: Pose| KeyPose {
        stage: Step::Withdraw.name().into(),
        pose,
        approach_m: 0.0,
        opening_m,
        until_contact_n: None,
        gripper: None,
        retreat_m: 0.0,
        lift_m: 0.0,
    };
    let obstacles = assignment.scene.obstacles();
    let mut refused = String::new();
    for share in RETREAT_SHARES.into_iter().chain([0.0]) {
        let open = Some(GripperCommand::Open { opening_m });
        let here = at(model.tool_pose(&start));
        let key_poses = [
            KeyPose { gripper: open, retreat_m: share * RETREAT_M, ..here },
            KeyPose { approach_m: HOMING_M, ..at(model.tool_pose(model.home())) },
        ];
        // Whatever is in the hand is let go of there.
        let task = MotionTask {
            start: &start,
            holding: true,
            carried: &[],
            key_poses: &key_poses,
            obstacles: &obstacles,
        };
        let outcome = plugins.motion.plan(model, plugins.kinematics.as_ref(), &task);
        match outcome.map_err(|e| e.to_string())? {
            MotionOutcome::Planned { program, .. } => {
                let mut watch = |sample: &RobotSample| {
                    acted.robot.push(sample.clone());
                    cancel.check()
                };
                for step in &program.steps {
                    plugins.robot.execute(&step.action, &mut watch).map_err(|e| e.to_string())?;
                }
                return Ok(());
            }
            MotionOutcome::Infeasible { reason, .. } => refused = reason,
        }
    }
    Err(format!("there is no way back: {refused}"))
}
