//! Carry the program out.

use super::assignment::Assignment;
use super::bench::Bench;
use super::execution::{Ended, Execution};
use super::plan::Planned;
use super::step::{Failed, StageEvent, Step};
use super::withdraw::Withdraw;
use bevy_ecs::prelude::*;
use seeone_plugin::{Judge, RobotSample};

/// The object at one moment, as its judge knows it.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// Seconds of the cell's clock.
    pub time_s: f64,
    /// Its vertices in `world`, metres.
    pub vertices: Vec<[f64; 3]>,
}

/// What the robot did, in all tries. `grasped` and `object` are what only a simulated cell
/// can know: they go into the verdict and the recording, and nowhere else.
#[derive(Component, Clone, Debug, Default, PartialEq)]
pub struct Acted {
    /// Where the robot was, about thirty times a second.
    pub robot: Vec<RobotSample>,
    /// Where the object was, about ten times a second.
    pub object: Vec<Snapshot>,
    /// Whether the object was held after the lift, in any try, where anybody could tell.
    pub grasped: Option<bool>,
    /// Whether it was in the first try.
    pub grasped_at_first: Option<bool>,
    /// Whether any try was carried out to its end.
    pub carried_out: bool,
    /// How often the robot reached for the object.
    pub tries: usize,
    /// How often the hand closed on nothing and looked again.
    pub missed: usize,
}

impl Acted {
    /// The cell's time of the last sample, seconds.
    pub fn end_s(&self) -> f64 {
        self.robot.last().map_or(0.0, |sample| sample.time_s)
    }
}

/// Left on a run that did not come out and has tries left: it looks again.
#[derive(Component, Clone, Copy, Debug)]
pub(super) struct Again;

pub(super) fn act(
    mut commands: Commands,
    mut bench: NonSendMut<Bench>,
    mut runs: Query<(Entity, &Assignment, &Planned, Option<&mut Acted>), Without<Failed>>,
) {
    for (run, assignment, planned, before) in &mut runs {
        if assignment.dry_run {
            continue;
        }
        let mut acted = before.map(|mut acted| std::mem::take(&mut *acted)).unwrap_or_default();
        acted.tries += 1;
        let last_try = acted.tries >= assignment.tries;
        let Planned { key_poses, carried, program, .. } = planned;
        let obstacles = &assignment.scene.obstacles();
        let cancel = &bench.cancel().clone();
        let (ended, _) = bench.timed(Step::Act, |plugins, tell| {
            let execution = Execution {
                robot: plugins.robot.as_mut(),
                judge: plugins.judge.as_deref_mut().map(|judge| judge as &mut dyn Judge),
                motion: plugins.motion.as_ref(),
                kinematics: plugins.kinematics.as_ref(),
                model: &assignment.robot,
                obstacles,
                carried,
                stages: &assignment.skill.stages,
                key_poses,
                program,
                acted: &mut acted,
                tell,
                last_try,
                cancel,
            };
            Ok(execution.run())
        });
        let ended =
            ended.unwrap_or_else(|reason| Err(Failed { stage: Step::Act.name().into(), reason }));
        match ended {
            Ok(Ended::Done) => acted.carried_out = true,
            Ok(Ended::Missed) => {
                acted.missed += 1;
                commands.entity(run).insert(Again);
            }
            Err(failed) => {
                let (name, reason) = (failed.stage.clone(), Some(failed.reason.clone()));
                bench.tell(StageEvent { name, ok: false, seconds: 0.0, reason });
                // Wherever the hand is now, it goes back before it looks.
                match last_try || cancel.is_ordered() {
                    true => commands.entity(run).insert(failed),
                    false => commands.entity(run).insert((Again, Withdraw)),
                };
            }
        }
        if acted.tries == 1 {
            acted.grasped_at_first = acted.grasped.or(Some(false).filter(|_| bench.has_judge()));
        }
        commands.entity(run).insert(acted);
    }
}
