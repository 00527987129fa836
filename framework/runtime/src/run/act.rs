//! Carry the program out.

use super::assignment::Assignment;
use super::bench::Bench;
use super::plan::Planned;
use super::step::{Failed, StageEvent, Step};
use crate::plugins::Plugins;
use bevy_ecs::prelude::*;
use seeone_plugin::{Action, GripReport, GripperCommand, Program, RobotSample};

/// Between two snapshots of the object in the recording, seconds.
const SNAPSHOT_PERIOD_S: f64 = 0.1;

/// The object at one moment, as its judge knows it.
#[derive(Clone, Debug, PartialEq)]
pub struct Snapshot {
    /// Seconds of the cell's clock.
    pub time_s: f64,
    /// Its vertices in `world`, metres.
    pub vertices: Vec<[f64; 3]>,
}

/// What the robot did. `grasped` and `object` are what only a simulated cell can know:
/// they go into the verdict and the recording, and nowhere else.
#[derive(Component, Clone, Debug, Default, PartialEq)]
pub struct Acted {
    /// Where the robot was, about thirty times a second.
    pub robot: Vec<RobotSample>,
    /// Where the object was, about ten times a second.
    pub object: Vec<Snapshot>,
    /// Whether the object was held after the lift, where anybody could tell.
    pub grasped: Option<bool>,
}

impl Acted {
    /// The cell's time of the last sample, seconds.
    pub fn end_s(&self) -> f64 {
        self.robot.last().map_or(0.0, |sample| sample.time_s)
    }
}

pub(super) fn act(
    mut commands: Commands,
    mut bench: NonSendMut<Bench>,
    runs: Query<(Entity, &Assignment, &Planned), Without<Failed>>,
) {
    for (run, assignment, planned) in &runs {
        if assignment.dry_run {
            continue;
        }
        let mut acted = Acted::default();
        let first = &assignment.skill.stages[0].name;
        let (done, _) = bench.timed(Step::Act, |plugins, tell| {
            Ok(carry_out(plugins, &planned.program, first, &mut acted, tell))
        });
        let done =
            done.unwrap_or_else(|reason| Err(Failed { stage: Step::Act.name().into(), reason }));
        if let Err(failed) = done {
            let (name, reason) = (failed.stage.clone(), Some(failed.reason.clone()));
            bench.tell(StageEvent { name, ok: false, seconds: 0.0, reason });
            commands.entity(run).insert(failed);
        }
        commands.entity(run).insert(acted);
    }
}

/// Carries out every step and tells of every stage that is done. What the robot goes by is
/// what its own gripper feels; the judge is asked for the verdict's sake alone.
fn carry_out(
    plugins: &mut Plugins,
    program: &Program,
    first: &str,
    acted: &mut Acted,
    tell: &mut dyn FnMut(StageEvent),
) -> Result<(), Failed> {
    let lifted = lifted(program, first);
    let mut carrying = false;
    let mut began_s = None;
    for (index, step) in program.steps.iter().enumerate() {
        let failed = |reason: String| Failed { stage: step.stage.clone(), reason };
        let report = execute(plugins, &step.action, acted).map_err(failed)?;
        match step.action {
            Action::Grip(GripperCommand::Close { .. }) if !report.holding => {
                let opening_mm = report.opening_m * 1e3;
                return Err(failed(format!("closed on nothing, at {opening_mm:.1} mm")));
            }
            Action::Grip(GripperCommand::Close { .. }) => carrying = true,
            Action::Grip(GripperCommand::Open { .. }) => carrying = false,
            Action::Move(_) if carrying && !report.holding => {
                return Err(failed(format!("lost the object on the way ({})", step.purpose)));
            }
            Action::Move(_) => {}
        }
        if Some(index) == lifted
            && let Some(judge) = &mut plugins.judge
        {
            acted.grasped = Some(judge.grasped().map_err(|e| failed(e.to_string()))?);
        }
        let began = *began_s.get_or_insert_with(|| acted.robot.first().map_or(0.0, |s| s.time_s));
        if program.steps.get(index + 1).is_none_or(|next| next.stage != step.stage) {
            let seconds = acted.end_s() - began;
            tell(StageEvent { name: step.stage.clone(), ok: true, seconds, reason: None });
            began_s = Some(acted.end_s());
        }
    }
    Ok(())
}

/// The step after which the object is judged to be held or not: the lift of the first
/// stage, or its last step when it has none.
fn lifted(program: &Program, first: &str) -> Option<usize> {
    let steps = &program.steps;
    steps
        .iter()
        .rposition(|step| step.stage == first && step.purpose == "lift")
        .or_else(|| steps.iter().rposition(|step| step.stage == first))
}

/// One action, with what is seen on the way.
fn execute(
    plugins: &mut Plugins,
    action: &Action,
    acted: &mut Acted,
) -> Result<GripReport, String> {
    let Plugins { robot, judge, .. } = plugins;
    let report = robot.execute(action, &mut |sample| {
        acted.robot.push(sample.clone());
        let due = |last: &Snapshot| sample.time_s >= last.time_s + SNAPSHOT_PERIOD_S - 1e-9;
        if let Some(judge) = judge
            && acted.object.last().is_none_or(due)
        {
            acted.object.push(Snapshot { time_s: sample.time_s, vertices: judge.object() });
        }
    });
    report.map_err(|e| e.to_string())
}
