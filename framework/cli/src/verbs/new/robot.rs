//! `new robot`: a robot file for an arm that a URDF describes.

use super::{check_name, check_vacant};
use crate::args::NewRobotArgs;
use crate::outputs::{make_folder, write_file};
use crate::{Ending, builtin, console};
use anyhow::Result;
use nalgebra::{Translation3, Vector3};
use seeone_collision::{Checker, Margins, Pairs, SAMPLES, sampled};
use seeone_core::pose::rotation_from_approach;
use seeone_core::random::{generator, uniform};
use seeone_core::robot::{RobotModel, RobotOptions};
use seeone_core::{Diagnostic, Pose};
use seeone_plugin::motion::Obstacle;
use seeone_plugin::{Clearance, IkQuery, IkStatus, Kind, Setup};
use seeone_runtime::Registry;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::fs;
use std::path::Path;

/// Where the tool may wait: shares of the arm's reach in front of the base, and heights above it.
const AHEAD: [f64; 5] = [0.35, 0.3, 0.4, 0.5, 0.6];
const ABOVE_M: [f64; 4] = [0.35, 0.3, 0.4, 0.5];
/// Postures from which each of these places is sought, ...
const STARTS: usize = 200;
/// ... and how much lower the arm may be held for a radian less of turning, metres.
const TURN_M: f64 = 0.01;
/// Seed of the postures by which the pairs of bodies are sorted, as in `seeone-collision`'s example.
const SEED: u64 = 1;

/// Writes `NAME.toml`, and the URDF beside it unless it lies there.
///
/// # Errors
/// A URDF that describes no arm with a gripper, a name that is none, files that are there already
/// or cannot be written, an arm that cannot wait with its hand down anywhere.
pub fn run(args: &NewRobotArgs) -> Result<Ending> {
    let path = args.folder.join(format!("{}.toml", args.name));
    check_name(&args.name)?;
    check_vacant(&[&path])?;
    let options = RobotOptions { tool_link: args.tool_link.clone(), ..RobotOptions::default() };
    let robot = RobotModel::from_urdf(&args.urdf, &options)?;
    let registry = builtin::registry();
    let home = home(&robot, &registry)?;
    console::tell(&format!("{} joints; sorting the pairs of its bodies ...", home.len()));
    let pairs = sampled(&robot, SAMPLES, SEED);
    let plugin = registry.names(Kind::Robot).into_iter().next().unwrap_or_default();
    make_folder(&args.folder)?;
    let urdf = beside(args)?;
    write_file(&path, text(args, &plugin, &urdf, &home, &options, &pairs).as_bytes())?;
    console::tell(&format!("wrote {}", path.display()));
    let next = path.display();
    console::tell(&format!("next: seeone check {next} && seeone check SKILL --robot {next}"));
    Ok(Ending::Success)
}

/// The URDF's name below the robot's folder, whereto it is copied if it lies elsewhere.
fn beside(args: &NewRobotArgs) -> Result<String, Diagnostic> {
    let fault = |e: std::io::Error| Diagnostic::new("R001", e.to_string()).in_file(&args.urdf);
    let (urdf, folder) = (fs::canonicalize(&args.urdf), fs::canonicalize(&args.folder));
    if let (Ok(urdf), Ok(folder)) = (urdf, folder)
        && let Ok(below) = urdf.strip_prefix(&folder)
    {
        return Ok(below.to_string_lossy().into_owned());
    }
    let name = format!("{}.urdf", args.name);
    let to = args.folder.join(&name);
    check_vacant(&[&to])?;
    write_file(&to, &fs::read(&args.urdf).map_err(fault)?)?;
    console::tell(&format!("wrote {}", to.display()));
    Ok(name)
}

/// A posture in which the hand points down in front of the base and nothing touches anything: of
/// those at the first place that has any, the one that holds the arm highest without much turning.
fn home(robot: &RobotModel, registry: &Registry) -> Result<Vec<f64>, Diagnostic> {
    let setup = Setup {
        config: &toml::Table::new(),
        root: Path::new("."),
        seed: SEED,
        robot: Some(robot),
        world: None,
    };
    let name = registry.names(Kind::Kinematics).into_iter().next().unwrap_or_default();
    let kinematics = registry.kinematics.build(&name, &setup)?;
    let table = [Obstacle::Table { height_m: 0.0, soft_m: 0.0 }];
    let opening_m = robot.gripper().stroke_m();
    let clearance = Checker::new(robot, Margins::default(), &table, opening_m);
    let mut rng = generator(SEED, "home");
    let joints = robot.joints();
    let middle: Vec<f64> = joints.iter().map(|j| 0.5 * (j.lower() + j.upper())).collect();
    let mut draw = || joints.iter().map(|j| uniform(&mut rng, j.lower(), j.upper())).collect();
    let starts: Vec<Vec<f64>> = (0..STARTS).map(|_| draw()).collect();
    let ease = |q: &[f64]| {
        let links = robot.forward(q);
        let height_m =
            links.iter().map(|link| link.translation.z).sum::<f64>() / links.len() as f64;
        let turns = q.iter().zip(&middle).map(|(q, middle)| (q - middle).abs()).sum::<f64>();
        height_m - TURN_M * turns
    };
    let reach_m = reach_m(robot);
    let down = rotation_from_approach(&-Vector3::z(), &Vector3::y());
    for (share, up_m) in AHEAD.iter().flat_map(|share| ABOVE_M.map(|up_m| (share, up_m))) {
        let place = Translation3::new(share * reach_m, 0.0, up_m);
        let target = robot.base() * Pose::from_parts(place, down);
        let solve = |near: &Vec<f64>| {
            let found = kinematics.solve(robot, &IkQuery::new(&target, near)).ok()?;
            let posture = unwound(robot, found.joints);
            let free = clearance.contact(&posture).is_none();
            (found.status == IkStatus::Solved && free).then_some(posture)
        };
        let found = starts.iter().filter_map(solve);
        if let Some(home) = found.max_by(|a, b| ease(a).total_cmp(&ease(b))) {
            return Ok(home);
        }
    }
    let cause =
        "the arm cannot wait with its hand down in front of its base without touching anything";
    Err(Diagnostic::new("B031", cause)
        .hint("look at the tool link: z along the approach, y along the closing direction"))
}

/// The same posture without whole turns that a joint could do without.
fn unwound(robot: &RobotModel, mut posture: Vec<f64>) -> Vec<f64> {
    for (q, joint) in posture.iter_mut().zip(robot.joints()) {
        let middle = 0.5 * (joint.lower() + joint.upper());
        let near = *q - TAU * ((*q - middle) / TAU).round();
        if joint.allows(near) {
            *q = near;
        }
    }
    posture
}

/// How far the tool can be from the base at most, metres: the lengths of all links.
fn reach_m(robot: &RobotModel) -> f64 {
    let links = robot.forward(robot.home());
    let steps =
        links.windows(2).map(|pair| pair[0].translation.vector - pair[1].translation.vector);
    steps.map(|step| step.norm()).sum::<f64>() + robot.tool().translation.vector.norm()
}

/// The robot file.
fn text(
    args: &NewRobotArgs,
    plugin: &str,
    urdf: &str,
    home: &[f64],
    options: &RobotOptions,
    pairs: &Pairs,
) -> String {
    let home: Vec<String> = home.iter().map(|q| format!("{q:.6}")).collect();
    let mut text = format!(
        "# {name}, simulated. A real arm has a robot plugin of its own.\n\
         schema = 1\n\
         name = {name:?}\n\
         plugin = {plugin:?}\n\
         urdf = {urdf:?}\n\
         # Where the base stands in `world`: the table's top is z = 0.\n\
         base = {{ xyz_m = [0.0, 0.0, 0.0], quat_xyzw = [0.0, 0.0, 0.0, 1.0] }}\n\
         tool_link = {tool:?}\n\
         # Hand down in front of the base. Clear of the camera's view is better.\n\
         home_rad = [{home}]\n\n\
         [limits]                                   # the speeds are the URDF's\n\
         acceleration_rad_s2 = {acceleration:?}\n\
         jerk_rad_s3 = {jerk:?}\n\n\
         # The gripper is taken for an AG-95; another one has a table [gripper] with force_n and reach_m.\n\n\
         # From {SAMPLES} drawn postures.\n\
         [collision]\n",
        name = args.name,
        tool = options.tool_link,
        home = home.join(", "),
        acceleration = options.acceleration,
        jerk = options.jerk,
    );
    for (key, pairs) in [("always", &pairs.always), ("never", &pairs.never)] {
        // Writing into a text does not fail.
        let _ = if pairs.is_empty() {
            writeln!(text, "{key} = []")
        } else {
            let rows: String = pairs.iter().map(|pair| format!("  {pair:?},\n")).collect();
            writeln!(text, "{key} = [\n{rows}]")
        };
    }
    text
}
