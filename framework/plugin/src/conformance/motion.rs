//! The rules of kind `motion`.

use super::arm::{Descent, arm};
use super::violation::{Violation, answered, answered_or_refused, cancelled, hold, refused, sound};
use crate::motion::Obstacle;
use crate::{
    Action, GripperCommand, IkOutcome, IkQuery, JointTrajectory, KeyPose, Kinematics, Motion,
    MotionOutcome, MotionTask, PluginError, Program,
};
use seeone_core::Pose;
use seeone_core::pose::difference;
use seeone_core::robot::RobotModel;
use std::sync::atomic::{AtomicUsize, Ordering};

/// How far apart the end of one move and the start of the next may be, radians.
const JOINED_RAD: f64 = 1e-6;
/// How far from its key pose the hand may act, metres.
const THERE_M: f64 = 2e-3;
/// A mat far below everything.
const MAT: Obstacle = Obstacle::Table { height_m: -0.5, soft_m: 0.0 };

/// A key pose that the arm reaches by turning its first joints by `turn` radians from home.
fn key(robot: &RobotModel, stage: &str, turn: f64, gripper: GripperCommand) -> KeyPose {
    let posture: Vec<f64> = robot.home().iter().map(|q| q + turn).collect();
    KeyPose {
        stage: stage.into(),
        pose: robot.tool_pose(&posture),
        approach_m: 0.0,
        opening_m: 0.03,
        until_contact_n: None,
        gripper: Some(gripper),
        retreat_m: 0.0,
        lift_m: 0.0,
    }
}

/// Holds every rule of the kind.
///
/// # Errors
/// The first rule that `plugin` breaks.
pub fn motion(plugin: &dyn Motion) -> Result<(), Violation> {
    let robot = arm();
    let keys = [
        key(&robot, "take", 0.1, GripperCommand::Close { force_n: 60.0 }),
        key(&robot, "put", -0.1, GripperCommand::Open { opening_m: 0.03 }),
    ];
    for count in 1..=keys.len() {
        goes_where_it_is_told(plugin, &robot, &keys[..count])?;
    }
    ends_with_its_kinematics(plugin, &robot, &keys)?;
    let ask = |keys: &[KeyPose], start: &[f64]| plan(plugin, &robot, keys, start);
    let rule = "a task without key poses is answered or refused";
    answered_or_refused(rule, || ask(&[], robot.home()), |outcome| outcome.check(&robot))?;

    let rule = "what is out of reach is infeasible, with its stage and a reason";
    let far = KeyPose { pose: Pose::translation(10.0, 0.0, 0.5), ..keys[1].clone() };
    let outcome = answered(rule, || ask(&[keys[0].clone(), far], robot.home()))?;
    let said = matches!(&outcome, MotionOutcome::Infeasible { stage, .. } if stage == "put");
    hold(rule, said, || format!("{outcome:?}"))?;
    sound(rule, outcome.check(&robot))?;

    for length in [0, 1, robot.joints().len() + 1] {
        refused("a start of another length is refused", || ask(&keys, &vec![0.1; length]))?;
    }
    refused("a start outside the limits is refused", || ask(&keys, &[9.0; 6]))?;
    let nowhere = KeyPose { pose: Pose::translation(f64::NAN, 0.0, 0.0), ..keys[0].clone() };
    refused("a pose that is not finite is refused", || ask(&[nowhere], robot.home()))
}

fn plan(
    plugin: &dyn Motion,
    robot: &RobotModel,
    key_poses: &[KeyPose],
    start: &[f64],
) -> Result<MotionOutcome, PluginError> {
    plan_with(plugin, &Descent::default(), robot, key_poses, start)
}

fn plan_with(
    plugin: &dyn Motion,
    kinematics: &dyn Kinematics,
    robot: &RobotModel,
    key_poses: &[KeyPose],
    start: &[f64],
) -> Result<MotionOutcome, PluginError> {
    let task = MotionTask { start, holding: false, carried: &[], key_poses, obstacles: &[MAT] };
    plugin.plan(robot, kinematics, &task)
}

/// The suite's kinematics until they have been asked `left` times more; then the caller wants an
/// end.
struct Interrupted {
    left: AtomicUsize,
    late: AtomicUsize,
}

impl Kinematics for Interrupted {
    fn solve(&self, robot: &RobotModel, query: &IkQuery) -> Result<IkOutcome, PluginError> {
        let goes_on = |left: usize| left.checked_sub(1);
        match self.left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, goes_on) {
            Ok(_) => Descent::default().solve(robot, query),
            Err(_) => {
                self.late.fetch_add(1, Ordering::Relaxed);
                Err(PluginError::Cancelled)
            }
        }
    }
}

/// However far it has come.
fn ends_with_its_kinematics(
    plugin: &dyn Motion,
    robot: &RobotModel,
    keys: &[KeyPose],
) -> Result<(), Violation> {
    let asked = Interrupted { left: AtomicUsize::new(usize::MAX), late: AtomicUsize::new(0) };
    let rule = "near key poses are planned for";
    answered(rule, || plan_with(plugin, &asked, robot, keys, robot.home()))?;
    let all = usize::MAX - asked.left.into_inner();
    for left in [0, all / 2, all.saturating_sub(1)] {
        let asked = Interrupted { left: AtomicUsize::new(left), late: AtomicUsize::new(0) };
        let rule = "a plan ends with the error of its kinematics";
        cancelled(rule, || plan_with(plugin, &asked, robot, keys, robot.home()))?;
        let late = asked.late.into_inner();
        let rule = "kinematics that want an end are asked no more";
        hold(rule, late == 1, || format!("{late} times after {left} of {all}"))?;
    }
    Ok(())
}

fn goes_where_it_is_told(
    plugin: &dyn Motion,
    robot: &RobotModel,
    keys: &[KeyPose],
) -> Result<(), Violation> {
    let rule = "near key poses are planned for";
    let outcome = answered(rule, || plan(plugin, robot, keys, robot.home()))?;
    let MotionOutcome::Planned { program, .. } = &outcome else {
        return Err(Violation { rule, detail: format!("{outcome:?}") });
    };
    sound("finite in, finite and within the limits out", outcome.check(robot))?;
    let rule = "the same input gives the same bytes";
    let again = answered(rule, || plan(plugin, robot, keys, robot.home()))?;
    hold(rule, outcome == again, || "two plans differ".into())?;
    is_in_one_piece(robot, program)?;

    let rule = "the hand acts at each key pose, in order";
    // Beside what the key poses say the hand may open on its way.
    let mut acts = acts(robot, program).into_iter();
    for key in keys {
        let as_told = |(stage, command, pose): (&str, GripperCommand, Pose)| {
            let there = difference(&pose, &key.pose).0 < THERE_M;
            there && stage == key.stage && Some(command) == key.gripper
        };
        hold(rule, acts.any(as_told), || format!("not at \"{}\"", key.stage))?;
    }
    Ok(())
}

fn trajectory(action: &Action) -> Option<&JointTrajectory> {
    match action {
        Action::Move(trajectory) | Action::MoveUntilContact { trajectory, .. } => Some(trajectory),
        Action::Grip(_) => None,
    }
}

fn is_in_one_piece(robot: &RobotModel, program: &Program) -> Result<(), Violation> {
    let rule = "each move begins where the arm is";
    let mut at = robot.home();
    for step in &program.steps {
        let Some(moved) = trajectory(&step.action) else { continue };
        let (Some(first), Some(last)) = (moved.positions.first(), moved.positions.last()) else {
            continue;
        };
        let jump = first.iter().zip(at).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        hold(rule, jump < JOINED_RAD, || format!("{jump:.2e} rad off in {}", step.stage))?;
        at = last;
    }
    Ok(())
}

/// What the hand does, and where the tool then is.
fn acts<'a>(robot: &RobotModel, program: &'a Program) -> Vec<(&'a str, GripperCommand, Pose)> {
    let mut at = robot.home();
    let mut acts = Vec::new();
    for step in &program.steps {
        match &step.action {
            Action::Grip(command) => acts.push((&*step.stage, *command, robot.tool_pose(at))),
            other => at = trajectory(other).and_then(|t| t.positions.last()).map_or(at, |q| q),
        }
    }
    acts
}
