//! The rules of kind `robot`.

use super::violation::{Violation, answered, cancelled, hold, refused, sound};
use crate::{Action, Felt, GripperCommand, JointTrajectory, PluginError, Robot, RobotSample};
use seeone_core::robot::RobotModel;

/// How far from where it was sent a robot may stop, radians.
const ARRIVED_RAD: f64 = 0.02;
/// Seconds a sample.
const PERIOD_S: f64 = 0.008;

/// Holds every rule of the kind for the robots that `build` makes of `model`, each in a cell
/// of its own, at home.
///
/// # Errors
/// The first rule that they break.
pub fn robot(
    model: &RobotModel,
    build: &dyn Fn() -> Result<Box<dyn Robot>, PluginError>,
) -> Result<(), Violation> {
    let rule = "a robot can be built";
    let mut first = answered(rule, build)?;
    let mut second = answered(rule, build)?;
    let done = carries_out(model, first.as_mut())?;
    let again = carries_out(model, second.as_mut())?;
    let rule = "the same actions give the same samples";
    hold(rule, done == again, || "two executions differ".into())?;
    let rule = "a robot can be built";
    refuses_what_is_wrong(model, answered(rule, build)?.as_mut())?;
    stops(model, answered(rule, build)?.as_mut())
}

/// Ends when the watcher asks for it, stands when it is told to, and goes on from there.
fn stops(model: &RobotModel, robot: &mut dyn Robot) -> Result<(), Violation> {
    let rule = "the state is the robot's";
    let start = answered(rule, || robot.state())?.joints;
    let there = moving(&start, -0.1, 200);
    let mut seen = 0;
    let rule = "an action ends when the watcher asks for it, with the watcher's error";
    cancelled(rule, || {
        robot.execute(&Action::Move(there.clone()), &mut |_| {
            seen += 1;
            if seen < 10 { Ok(()) } else { Err(PluginError::Cancelled) }
        })
    })?;
    hold(rule, seen == 10, || format!("{seen} samples, the end asked for at the tenth"))?;
    let rule = "a robot that was interrupted is on its way, and not at its end";
    let interrupted = answered(rule, || robot.state())?.joints;
    let off =
        |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let (gone, left) = (off(&interrupted, &start), off(&interrupted, &there.positions[199]));
    hold(rule, gone < 0.05 && left > 0.05, || format!("{gone:.3} rad gone, {left:.3} left"))?;

    let rule = "a robot that is stopped holds its position";
    answered(rule, || robot.stop())?;
    let stopped = answered(rule, || robot.state())?.joints;
    hold(rule, stopped == interrupted, || format!("from {interrupted:?} to {stopped:?}"))?;
    let rule = "a robot that was stopped goes on from there";
    let onward = Action::Move(moving(&stopped, 0.05, 100));
    let told = answered(rule, || robot.execute(&onward, &mut |_| Ok(())))?;
    sound(rule, told.check())?;
    sound(rule, answered(rule, || robot.state())?.check(Some(model.joints().len())))
}

/// A slow move from `from` by `turn` radians of every joint, in `samples` samples.
fn moving(from: &[f64], turn: f64, samples: usize) -> JointTrajectory {
    let last = samples.saturating_sub(1).max(1) as f64;
    // At rest at both ends.
    let share = |i: usize| 0.5 - 0.5 * (std::f64::consts::PI * i as f64 / last).cos();
    let sample = |i: usize| from.iter().map(|q| q + turn * share(i)).collect();
    JointTrajectory { period_s: PERIOD_S, positions: (0..samples).map(sample).collect() }
}

/// Moves and grips, and says what was seen and felt.
fn carries_out(
    model: &RobotModel,
    robot: &mut dyn Robot,
) -> Result<(Vec<RobotSample>, Vec<Felt>), Violation> {
    let joints = Some(model.joints().len());
    let rule = "the state is the robot's";
    let start = answered(rule, || robot.state())?;
    sound(rule, start.check(joints))?;

    let mut seen: Vec<RobotSample> = Vec::new();
    let mut felt = Vec::new();
    let there = moving(&start.joints, -0.1, 200);
    let goal = there.positions.last().cloned().unwrap_or_default();
    for action in [
        Action::Move(moving(&start.joints, 0.0, 1)),
        Action::Move(there),
        Action::Grip(GripperCommand::Close { force_n: model.gripper().force_range_n()[0] }),
        Action::Grip(GripperCommand::Open { opening_m: 0.02 }),
    ] {
        let rule = "what can be done is done";
        let told = answered(rule, || {
            robot.execute(&action, &mut |sample| {
                seen.push(sample.clone());
                Ok(())
            })
        })?;
        sound("what is felt is finite", told.check())?;
        felt.push(told);
    }
    let rule = "the watcher sees the robot on its way, in order";
    hold(rule, !seen.is_empty(), || "nothing".into())?;
    for sample in &seen {
        sound(rule, sample.check(joints))?;
    }
    hold(rule, seen.is_sorted_by_key(|sample| sample.time_s), || "out of order".into())?;

    let rule = "the robot is where it was sent";
    let end = answered(rule, || robot.state())?;
    let off = end.joints.iter().zip(&goal).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    hold(rule, off < ARRIVED_RAD, || format!("{off:.3} rad off"))?;
    Ok((seen, felt))
}

fn refuses_what_is_wrong(model: &RobotModel, robot: &mut dyn Robot) -> Result<(), Violation> {
    let start = answered("the state is the robot's", || robot.state())?.joints;
    let mut hears =
        |rule, action: Action| refused(rule, || robot.execute(&action, &mut |_| Ok(())));
    let mut follows = |rule, spoil: &dyn Fn(&mut JointTrajectory)| {
        let mut trajectory = moving(&start, 0.0, 20);
        spoil(&mut trajectory);
        hears(rule, Action::Move(trajectory))
    };
    follows("an empty trajectory is refused", &|t| t.positions.clear())?;
    follows("a sample of another length is refused", &|t| t.positions[3].truncate(1))?;
    follows("a sample without joints is refused", &|t| t.positions[3].clear())?;
    follows("a sample that is not finite is refused", &|t| t.positions[3][0] = f64::NAN)?;
    follows("a sample outside the limits is refused", &|t| t.positions[19][0] = 99.0)?;
    follows("a start elsewhere is refused", &|t| {
        t.positions.iter_mut().for_each(|sample| sample[0] += 0.5);
    })?;
    for period_s in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        follows("a period that is none is refused", &move |t| t.period_s = period_s)?;
    }
    for number in [-1.0, f64::NAN, f64::INFINITY] {
        let rule = "a command to the gripper that is none is refused";
        hears(rule, Action::Grip(GripperCommand::Close { force_n: number }))?;
        hears(rule, Action::Grip(GripperCommand::Open { opening_m: number }))?;
    }
    // What is refused moves nothing.
    let rule = "what is refused moves nothing";
    let still = answered(rule, || robot.state())?.joints;
    hold(rule, still == start, || format!("from {start:?} to {still:?}"))?;
    sound(rule, if model.within_limits(&still) { Ok(()) } else { Err(format!("{still:?}")) })
}
