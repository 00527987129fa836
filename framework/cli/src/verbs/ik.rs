//! `ik`: joint positions for a file of poses or of paths.

use crate::args::{Frame, IkArgs};
use crate::faults::Faults;
use crate::follow::{Followed, Follower};
use crate::outputs::write_file;
use crate::targets::{self, Target};
use crate::{Ending, builtin, console};
use anyhow::{Context, Result};
use seeone_collision::{Checker, Margins};
use seeone_core::robot::RobotModel;
use seeone_core::{Diagnostic, Pose};
use seeone_plugin::motion::Obstacle;
use seeone_plugin::{Clearance, IkOutcome, IkQuery, IkStatus, Kind, Kinematics, Setup};
use seeone_runtime::files::{KnownMethods, RobotFile, Scene};
use serde::Serialize;
use serde_json::Value;
use std::path::Path;
use std::time::Instant;

/// The flange's link in robot descriptions (REP-199).
const FLANGE: &str = "tool0";

/// The answer to one pose.
#[derive(Serialize)]
struct Answer<'a> {
    id: &'a Value,
    q: Option<Vec<f64>>,
    status: &'static str,
    time_us: f64,
    position_error_m: f64,
    rotation_error_rad: f64,
    collision: Option<String>,
    reason: Option<String>,
}

/// The answer to one path.
#[derive(Serialize)]
struct PathAnswer<'a> {
    id: &'a Value,
    q: Vec<Vec<f64>>,
    fraction: f64,
    reason: Option<String>,
}

/// Answers every target.
///
/// # Errors
/// Every fault of the files, an unknown plugin, or a file that cannot be written.
pub fn run(args: &IkArgs) -> Result<Ending> {
    let mut registry = builtin::registry();
    builtin::load(&mut registry, &args.libraries)?;
    let known = registry.known();
    let file = RobotFile::read(&args.robot, &known).map_err(Faults)?;
    let robot = model(&file, args.frame)?;
    let obstacles = obstacles(args.scene.as_deref(), &known)?;
    let table = file.config.get(&Kind::Kinematics).cloned().unwrap_or_default();
    let setup = Setup {
        config: &table,
        root: Path::new("."),
        seed: args.seed,
        robot: Some(&robot),
        world: None,
    };
    let kinematics = registry.kinematics.build(&method(args, &known)?, &setup)?;
    // The fingers reach furthest to the sides when they are open.
    let opening_m = robot.gripper().stroke_m();
    let clearance = Checker::new(&robot, Margins::default(), &obstacles, opening_m);
    let shift = shift(args, &robot)?;
    let asked =
        Asked { robot: &robot, kinematics: kinematics.as_ref(), clearance: &clearance, shift };
    let lines = match (&args.path, &args.targets) {
        (Some(Some(path)), _) | (Some(None), Some(path)) => asked.paths(path, args.seed)?,
        (None, Some(path)) => asked.poses(path, args.from_home)?,
        (_, None) => {
            let fault = Diagnostic::new("I001", "no file of targets is named");
            return Err(fault.hint("name it with --targets").into());
        }
    };
    let text = format!("[\n{}\n]", lines.join(",\n"));
    match &args.out {
        Some(out) => write_file(out, (text + "\n").as_bytes())?,
        None => console::answer(&text)?,
    }
    Ok(Ending::Success)
}

/// The robot with the frame that is asked for as its tool.
fn model(file: &RobotFile, frame: Frame) -> Result<RobotModel, Diagnostic> {
    let mut file = file.clone();
    if frame == Frame::Tool0 {
        file.options.tool_link = FLANGE.into();
    }
    file.model()
}

/// From the frame that is asked for to the tool frame of the robot.
fn shift(args: &IkArgs, robot: &RobotModel) -> Result<Pose, Diagnostic> {
    let stroke = robot.gripper().stroke_m();
    if !(0.0..=stroke).contains(&args.opening) {
        let cause = format!("--opening {}: the pads open by 0 to {stroke} m", args.opening);
        return Err(Diagnostic::new("I006", cause).hint("give metres, 0.05 for 5 cm"));
    }
    match args.frame {
        Frame::Tool0 => Ok(Pose::identity()),
        Frame::Tcp => Ok(robot.tool_at(args.opening).inverse() * robot.tool()),
    }
}

fn obstacles(scene: Option<&Path>, known: &KnownMethods) -> Result<Vec<Obstacle>> {
    let scene = scene.map(|path| Scene::read(path, known).map_err(Faults)).transpose()?;
    Ok(scene.map(|scene| scene.obstacles()).unwrap_or_default())
}

/// The plugin that is asked for, or the first of its kind.
fn method(args: &IkArgs, known: &KnownMethods) -> Result<String, Diagnostic> {
    if let Some((kind, _)) = args.methods.iter().find(|(kind, _)| *kind != Kind::Kinematics) {
        let cause = format!("--method {kind}=...: no {kind} is asked here");
        return Err(Diagnostic::new("M003", cause).hint("the kind that is asked is kinematics"));
    }
    let chosen = args.methods.last().map(|(_, name)| name.clone());
    let first = || known.get(&Kind::Kinematics).and_then(|names| names.first().cloned());
    chosen.or_else(first).ok_or_else(|| Diagnostic::new("M003", "there is no kinematics plugin"))
}

/// Who is asked, and about what.
struct Asked<'a> {
    robot: &'a RobotModel,
    kinematics: &'a dyn Kinematics,
    clearance: &'a dyn Clearance,
    /// The robot's tool frame in the frame whose poses are given.
    shift: Pose,
}

impl Asked<'_> {
    /// A line of JSON for each target.
    fn poses(&self, file: &Path, from_home: bool) -> Result<Vec<String>> {
        let targets = targets::poses(file)?;
        let mut near = self.robot.home().to_vec();
        let (mut lines, mut times) = (Vec::with_capacity(targets.len()), Vec::new());
        let (mut solved, mut touching) = (0, 0);
        for Target { id, wanted } in &targets {
            let clock = Instant::now();
            let outcome = self.solve(&self.tool(wanted), &near)?;
            let time_us = 1e6 * clock.elapsed().as_secs_f64();
            times.push(time_us);
            let found = outcome.status == IkStatus::Solved;
            solved += usize::from(found);
            touching += usize::from(found && outcome.contact.is_some());
            if found && !from_home {
                near.clone_from(&outcome.joints);
            }
            lines.push(serde_json::to_string(&answer(id, outcome, time_us))?);
        }
        times.sort_by(f64::total_cmp);
        let share = |share: f64| times.get((share * times.len() as f64) as usize).unwrap_or(&0.0);
        console::tell(&format!(
            "{solved} of {} solved, {touching} of them touching something; median {:.1}, 95 % {:.1} us",
            targets.len(),
            share(0.5),
            share(0.95),
        ));
        Ok(lines)
    }

    /// The tool in `world` for a pose of the asked frame in the base link.
    fn tool(&self, pose: &Pose) -> Pose {
        self.robot.base() * pose * self.shift
    }

    fn solve(&self, target: &Pose, near: &[f64]) -> Result<IkOutcome> {
        let query = IkQuery { clearance: Some(self.clearance), ..IkQuery::new(target, near) };
        self.kinematics.solve(self.robot, &query).context("kinematics")
    }

    /// A line of JSON for each path.
    fn paths(&self, file: &Path, seed: u64) -> Result<Vec<String>> {
        let targets = targets::paths(file)?;
        let Self { robot, kinematics, clearance, .. } = *self;
        let follower = Follower { robot, kinematics, clearance, seed };
        let mut lines = Vec::with_capacity(targets.len());
        let mut whole = 0;
        for Target { id, wanted } in &targets {
            let poses: Vec<Pose> = wanted.iter().map(|pose| self.tool(pose)).collect();
            let followed = follower.follow(&poses).context("kinematics")?;
            whole += usize::from(followed.joints.len() == poses.len());
            lines.push(serde_json::to_string(&path_answer(id, followed, poses.len()))?);
        }
        console::tell(&format!("{whole} of {} paths followed to the end", targets.len()));
        Ok(lines)
    }
}

fn answer(id: &Value, outcome: IkOutcome, time_us: f64) -> Answer<'_> {
    let solved = outcome.status == IkStatus::Solved;
    Answer {
        id,
        q: solved.then_some(outcome.joints),
        status: if solved { "solved" } else { "infeasible" },
        time_us: (10.0 * time_us).round() / 10.0,
        position_error_m: outcome.position_error_m,
        rotation_error_rad: outcome.rotation_error_rad,
        collision: outcome.contact.map(|contact| contact.bodies.join("-")),
        reason: outcome.reason,
    }
}

fn path_answer(id: &Value, followed: Followed, poses: usize) -> PathAnswer<'_> {
    let contact = followed.contact.map(|(at, contact)| format!("pose {at}: {contact}"));
    PathAnswer {
        id,
        fraction: followed.joints.len() as f64 / poses as f64,
        q: followed.joints,
        reason: followed.reason.or(contact),
    }
}
