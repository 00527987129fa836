//! One program on its way through the robot.
//!
//! What the robot goes by is what its own gripper and wrist feel; the judge is asked for
//! the verdict's sake alone. Two things that it may feel change the program: contact that
//! ends a line, after which what is left is planned anew from there, and fingers that close
//! on nothing, after which the hand goes back the way it came, to look again.

use super::act::{Acted, Snapshot};
use super::cancel::Cancel;
use super::onward::onward;
use super::plan::RETREAT_SHARES;
use super::step::{Failed, StageEvent};
use crate::files::Stage;
use nalgebra::Point3;
use seeone_core::pose::difference;
use seeone_core::robot::RobotModel;
use seeone_plugin::motion::Obstacle;
use seeone_plugin::{
    Action, Felt, GripperCommand, JointTrajectory, Judge, KeyPose, Kinematics, Motion,
    MotionOutcome, MotionTask, Program, Robot, Step,
};
use std::collections::VecDeque;

/// Between two snapshots of the object in the recording, seconds.
const SNAPSHOT_PERIOD_S: f64 = 0.1;

/// How a program ended that did not fail.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    /// All of it was carried out.
    Done,
    /// The hand closed on nothing and is back where it started.
    Missed,
}

/// A program being carried out.
pub struct Execution<'a> {
    /// What moves.
    pub robot: &'a mut dyn Robot,
    /// Whoever can tell how the cell really is.
    pub judge: Option<&'a mut dyn Judge>,
    /// Plans the way on after contact, ...
    pub motion: &'a dyn Motion,
    /// ... with these kinematics.
    pub kinematics: &'a dyn Kinematics,
    /// The robot's model.
    pub model: &'a RobotModel,
    /// What it must not touch.
    pub obstacles: &'a [Obstacle],
    /// Points of what it takes, in the closed hand's tool frame, metres.
    pub carried: &'a [Point3<f64>],
    /// The skill's stages, whose ...
    pub stages: &'a [Stage],
    /// ... key poses these are, at least one, and ...
    pub key_poses: &'a [KeyPose],
    /// ... the program through them.
    pub program: &'a Program,
    /// Where what was done is noted.
    pub acted: &'a mut Acted,
    /// Told of every stage as it ends, but not of one that fails.
    pub tell: &'a mut dyn FnMut(StageEvent),
    /// Whether closing on nothing is the end.
    pub last_try: bool,
    /// Ends it from outside.
    pub cancel: &'a Cancel,
}

/// What is known of the program's past.
struct Past {
    /// When the stage under way began, seconds.
    began_s: Option<f64>,
    /// Whether something is in the hand.
    carrying: bool,
    /// The moves so far, as long as each was carried out to its end.
    moves: Option<Vec<JointTrajectory>>,
    /// What is to be told of the stage under way.
    note: Option<String>,
}

impl Execution<'_> {
    /// Carries out every step and tells of every stage that is done.
    ///
    /// # Errors
    /// The stage that failed, and why.
    pub fn run(mut self) -> Result<Ended, Failed> {
        let mut steps: VecDeque<Step> = self.program.steps.iter().cloned().collect();
        let began_s = self.acted.robot.last().map(|sample| sample.time_s);
        let mut past = Past { began_s, carrying: false, moves: Some(Vec::new()), note: None };
        while let Some(step) = steps.pop_front() {
            let failed = |reason: String| Failed { stage: step.stage.clone(), reason };
            let felt = self.execute(&step.action).map_err(failed)?;
            match &step.action {
                Action::Grip(GripperCommand::Close { .. }) if !felt.holding => {
                    let reason = format!("closed on nothing, at {:.1} mm", felt.opening_m * 1e3);
                    return match past.moves.take() {
                        Some(moves) if !self.last_try && step.stage == self.first() => {
                            self.retrace(moves).map_err(failed)?;
                            self.told(&step, &past, false, Some(reason));
                            Ok(Ended::Missed)
                        }
                        _ => Err(failed(reason)),
                    };
                }
                Action::Grip(command) => {
                    past.carrying = matches!(command, GripperCommand::Close { .. });
                }
                Action::MoveUntilContact { .. } if felt.contact => {
                    let pushed_out = past.carrying && !felt.holding;
                    let (rest, short_m) = self.replan(&step, &past, pushed_out).map_err(failed)?;
                    steps = rest;
                    past.carrying = felt.holding;
                    past.moves = None;
                    let what = if pushed_out { "pushed out of the hand" } else { "contact" };
                    past.note = Some(format!("{what} {:.0} mm before the pose", short_m * 1e3));
                }
                Action::Move(_) | Action::MoveUntilContact { .. }
                    if past.carrying && !felt.holding =>
                {
                    let purpose = step.purpose;
                    return Err(failed(format!("lost the object on the way ({purpose})")));
                }
                Action::Move(trajectory) | Action::MoveUntilContact { trajectory, .. } => {
                    past.moves.iter_mut().for_each(|moves| moves.push(trajectory.clone()));
                }
            }
            if self.lifted(&step, &steps)
                && let Some(judge) = &mut self.judge
            {
                self.acted.grasped = Some(judge.grasped().map_err(|e| failed(e.to_string()))?);
            }
            if steps.front().is_none_or(|next| next.stage != step.stage) {
                let note = past.note.take();
                self.told(&step, &past, true, note);
                past.began_s = Some(self.acted.end_s());
            }
        }
        Ok(Ended::Done)
    }

    fn first(&self) -> &str {
        &self.key_poses[0].stage
    }

    /// Whether this is the step after which the object is judged to be held or not: the lift
    /// of the first stage, or its last step when it has none.
    fn lifted(&self, step: &Step, rest: &VecDeque<Step>) -> bool {
        let mut to_come = rest.iter().filter(|next| next.stage == self.first());
        self.acted.grasped != Some(true)
            && step.stage == self.first()
            && (step.purpose == "lift" || to_come.next().is_none())
    }

    /// After contact in `step`'s line: the way on from where the arm now is, where the
    /// gripper does what it was to do at the key pose; and how far that is from here, metres.
    /// Where the object was `pushed_out` of the hand it is where it was to be put: the hand opens
    /// here as it was to open later, and goes.
    fn replan(
        &mut self,
        step: &Step,
        past: &Past,
        pushed_out: bool,
    ) -> Result<(VecDeque<Step>, f64), String> {
        let state = self.robot.state().map_err(|e| e.to_string())?;
        let here = self.model.tool_pose(&state.joints);
        let ahead = self.key_poses.iter().skip_while(|key| key.stage != step.stage);
        let mut ahead: Vec<KeyPose> = ahead.cloned().collect();
        let key = ahead.first().ok_or("the program has a stage without a key pose")?;
        let short_m = difference(&here, &key.pose).0;
        onward(self.stages, &here, &mut ahead);
        let opens = |key: &KeyPose| matches!(key.gripper, Some(GripperCommand::Open { .. }));
        if pushed_out && let Some(opening) = ahead.iter().position(opens) {
            ahead.drain(..opening);
        }
        ahead[0] =
            KeyPose { pose: here, approach_m: 0.0, until_contact_n: None, ..ahead[0].clone() };
        // What touches keeps away from nothing any more: it is there already.
        let (start, holding, carried) = (&state.joints, past.carrying, &[]);
        let obstacles = self.obstacles;
        let mut refused = String::new();
        for share in RETREAT_SHARES {
            let mut key_poses = ahead.clone();
            key_poses.iter_mut().for_each(|key| key.retreat_m *= share);
            let task = MotionTask { start, holding, carried, key_poses: &key_poses, obstacles };
            let outcome = self.motion.plan(self.model, self.kinematics, &task);
            match outcome.map_err(|e| e.to_string())? {
                MotionOutcome::Planned { program, .. } => {
                    return Ok((program.steps.into(), short_m));
                }
                MotionOutcome::Infeasible { stage, reason } => {
                    refused = format!("{stage}: {reason}");
                }
            }
        }
        Err(format!("felt contact, and there is no way on from there: {refused}"))
    }

    /// Opens the fingers and goes back the way the hand came.
    fn retrace(&mut self, moves: Vec<JointTrajectory>) -> Result<(), String> {
        let opening_m = self.key_poses[0].opening_m;
        self.execute(&Action::Grip(GripperCommand::Open { opening_m }))?;
        for mut trajectory in moves.into_iter().rev() {
            trajectory.positions.reverse();
            self.execute(&Action::Move(trajectory))?;
        }
        Ok(())
    }

    fn told(&mut self, step: &Step, past: &Past, ok: bool, reason: Option<String>) {
        let started = || self.acted.robot.first().map_or(0.0, |sample| sample.time_s);
        let seconds = self.acted.end_s() - past.began_s.unwrap_or_else(started);
        (self.tell)(StageEvent { name: step.stage.clone(), ok, seconds, reason });
    }

    /// One action, with what is seen on the way.
    fn execute(&mut self, action: &Action) -> Result<Felt, String> {
        let Self { robot, judge, acted, cancel, .. } = self;
        cancel.check().map_err(|e| e.to_string())?;
        let felt = robot.execute(action, &mut |sample| {
            acted.robot.push(sample.clone());
            let due = |last: &Snapshot| sample.time_s >= last.time_s + SNAPSHOT_PERIOD_S - 1e-9;
            if let Some(judge) = judge
                && acted.object.last().is_none_or(due)
            {
                acted.object.push(Snapshot { time_s: sample.time_s, vertices: judge.object() });
            }
            cancel.check()
        });
        felt.map_err(|e| e.to_string())
    }
}
