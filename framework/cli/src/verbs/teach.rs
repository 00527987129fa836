//! `teach`: a scripted expert, which knows the true mesh, shows a skill once in the
//! simulated cell. What is kept is what any demonstration is: one cloud and key poses.

mod hanging;
mod wearing;

use crate::args::{Shown, TeachArgs};
use crate::builtin;
use crate::faults::Faults;
use crate::simulated::SimulatedCell;
use crate::{Ending, console, objects};
use anyhow::{Context, Result, anyhow};
use nalgebra::Point3;
use seeone_core::formats::ply::{self, Encoding};
use seeone_core::frames::write_whole;
use seeone_core::{Cloud, Diagnostic, Pose};
use seeone_plugin::{
    GripperCommand, Judge, KeyPose, Kind, Measure, MotionOutcome, MotionTask, Program, Setup,
};
use seeone_runtime::files::{
    Demonstration, RelativeTo, RobotFile, Scene, ShownResult, Skill, Stage, is_name,
};
use seeone_runtime::plugins::configuration;
use seeone_runtime::run::{Acted, Cancel, Execution, Hull};
use seeone_sim::cell::Cell;
use seeone_sim::expert::VisorGrasp;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The hand comes from so much above the visor's plane.
const PITCH_DEG: f64 = 2.0;
/// Grip force, newtons, of the 45 to 160 that an AG-95 has: enough to hold a visor flat
/// between pads that come at it from above its plane.
const GRIP_N: f64 = 140.0;
/// The hand comes so far open around a visor, metres: where it is not seen, it is told some 15 mm
/// off.
const OPENING_M: f64 = 0.045;
/// A cloud of more points is thinned to about so many.
const CLOUD_POINTS: usize = 4096;
/// How far from where the shown one lay an object may lie, metres: caps that are worn alike lie so
/// far apart for their shapes alone (standard deviations of 12 mm along y and 13 along z over the
/// training caps, and as much again for the perception); ...
const WITHIN_M: f64 = 0.05;
/// ... and how far its up axis may be turned, degrees: what the perception of a worn cap is sure of.
const WITHIN_DEG: f64 = 5.0;
/// A demonstration that ends farther from the worn state teaches nothing, share of d.
const TOLERANCE_D: f64 = 0.1;

/// Shows the skill, and writes it when it succeeded.
///
/// # Errors
/// When a file is wrong or cannot be written, or a plugin cannot be built. A demonstration that
/// fails is told, and nothing is written.
pub fn run(args: &TeachArgs) -> Result<Ending> {
    let registry = builtin::registry();
    let known = registry.known();
    let scene = Scene::read(&args.scene, &known).map_err(Faults)?;
    let robot_file = RobotFile::read(&args.robot, &known).map_err(Faults)?;
    let robot = robot_file.model()?;
    let object = objects::resolve(&args.object)?;
    let name = args.skill.file_stem().and_then(|stem| stem.to_str());
    let name = name.filter(|name| is_name(name)).ok_or_else(|| {
        Diagnostic::new("S021", "a skill cannot be named as this file is")
            .in_file(&args.skill)
            .hint("at most 64 small letters, digits and hyphens, the first a letter")
    })?;

    let cell = SimulatedCell::drop(&scene, object.clone(), args.seed)?;
    let config = configuration(&scene, &robot_file);
    let empty = toml::Table::new();
    let setup = |kind| Setup {
        config: config.get(&kind).unwrap_or(&empty),
        root: Path::new("."),
        seed: args.seed,
        robot: Some(&robot),
        world: Some(cell.world()),
    };
    let mut camera = registry.camera.build("camera-sim", &setup(Kind::Camera))?;
    let kinematics = registry.kinematics.build("qp-ik", &setup(Kind::Kinematics))?;
    let motion = registry.motion.build("motion", &setup(Kind::Motion))?;
    let mut arm = registry.robot.build(&robot_file.plugin, &setup(Kind::Robot))?;
    let observation = camera.observe()?;

    let lesson = match args.show {
        Shown::Wearing => wearing::lesson(&cell, &scene)?,
        Shown::Hanging => hanging::lesson(&cell, &scene)?,
    };
    let last = lesson.stages.last().ok_or_else(|| anyhow!("the lesson has no stage"))?;
    let key_poses: Vec<KeyPose> =
        lesson.stages.iter().map(|stage| stage.key_pose(stage.gripper_pose)).collect();
    let start = arm.state()?.joints;
    let obstacles = scene.obstacles();
    let carried = Hull::of(&observation.cloud).in_the_hand(&key_poses);
    let task = MotionTask {
        start: &start,
        holding: false,
        carried: &carried,
        key_poses: &key_poses,
        obstacles: &obstacles,
    };
    let program: Program = match motion.plan(&robot, kinematics.as_ref(), &task)? {
        MotionOutcome::Planned { program, .. } => program,
        MotionOutcome::Infeasible { stage, reason } => {
            console::tell(&format!("the expert cannot show {stage}: {reason}; try another --seed"));
            return Ok(Ending::Failure);
        }
    };
    let mut judge = cell.judge();
    let mut acted = Acted::default();
    let execution = Execution {
        robot: arm.as_mut(),
        judge: Some(&mut judge),
        motion: motion.as_ref(),
        kinematics: kinematics.as_ref(),
        model: &robot,
        obstacles: &obstacles,
        carried: &carried,
        stages: &lesson.stages,
        key_poses: &key_poses,
        program: &program,
        acted: &mut acted,
        tell: &mut |_| (),
        last_try: true,
        cancel: &Cancel::default(),
    };
    if let Err(failed) = execution.run() {
        console::tell(&format!("the expert failed at {}: {}", failed.stage, failed.reason));
        return Ok(Ending::Failure);
    }
    let grasped = acted.grasped == Some(true);
    let verdict = judge.judge(&lesson.measure, grasped)?;
    console::tell(&format!("shown with {}: {}", object.name(), verdict.reason));
    if !verdict.success {
        console::tell("the demonstration failed; nothing was written; try another --seed");
        return Ok(Ending::Failure);
    }
    // Looked at as a run will: the hand is back where it waits.
    let home = Stage::through("look", RelativeTo::Object, robot.tool_pose(robot.home()));
    let start = arm.state()?.joints;
    let look = MotionTask {
        start: &start,
        holding: false,
        carried: &[],
        key_poses: &[home.key_pose(home.gripper_pose)],
        obstacles: &obstacles,
    };
    if let MotionOutcome::Planned { program, .. } =
        motion.plan(&robot, kinematics.as_ref(), &look)?
    {
        for step in &program.steps {
            arm.execute(&step.action, &mut |_| Ok(()))?;
        }
    }
    if let Some(right) = lesson.set_right {
        let mut cell = cell.cell.lock().map_err(|_| anyhow!("the simulated cell broke down"))?;
        cell.lay(&right)?;
    }
    let seen_result = camera.observe()?.cloud;
    let folder = args.skill.with_extension("");
    let result = shown_result(last, &folder.join("result.ply")).filter(|_| !seen_result.is_empty());
    let skill = Skill {
        name: name.to_owned(),
        category: object.category().to_owned(),
        summary: lesson.summary.into(),
        demonstration: Demonstration {
            cloud: folder.join("demonstration.ply"),
            camera_position: observation.camera_position,
            frames: lesson.frames,
        },
        stages: lesson.stages,
        methods: BTreeMap::from([
            (Kind::Perception, "nst".to_owned()),
            (Kind::Encoding, "nse".to_owned()),
            (Kind::Alignment, "procrustes".to_owned()),
            (Kind::Transfer, "feature-match".to_owned()),
            (Kind::Kinematics, "qp-ik".to_owned()),
            (Kind::Motion, "motion".to_owned()),
        ]),
        result,
        measure: lesson.measure,
    };
    write(&skill, &args.skill, &observation.cloud, &seen_result)?;
    Ok(Ending::Success)
}

/// What the expert shows.
struct Lesson {
    summary: &'static str,
    frames: BTreeMap<String, Pose>,
    stages: Vec<Stage>,
    /// Where the object's vertices (world, metres) come to lie when the expert sets right by hand
    /// what the gripper left a little askew: the result that is shown is the one that is wanted,
    /// for whatever it is off by, every robot that learns from it takes for right.
    set_right: Option<Vec<Point3<f64>>>,
    measure: Measure,
}

/// The result to be looked for after `last`, in the frame that it moves with.
fn shown_result(last: &Stage, cloud: &Path) -> Option<ShownResult> {
    let RelativeTo::Frame(frame) = &last.relative_to else { return None };
    Some(ShownResult {
        cloud: cloud.to_owned(),
        frame: frame.clone(),
        within_m: WITHIN_M,
        within_deg: WITHIN_DEG,
    })
}

/// The visor's front edge, by which the expert takes every cap, and the cell as it is now.
pub fn grasp(cell: &SimulatedCell) -> Result<(VisorGrasp, Cell)> {
    let cell = cell.cell.lock().map_err(|_| anyhow!("the simulated cell broke down"))?;
    let object = cell.object();
    let grasp = VisorGrasp::of(object, PITCH_DEG.to_radians())
        .ok_or_else(|| anyhow!("{} has no visor to take it by", object.name()))?;
    Ok((grasp, cell.clone()))
}

fn missing(scene: &Scene, what: &str) -> Diagnostic {
    Diagnostic::new("M005", format!("scene {:?} has no {what}", scene.name))
}

/// Taking the object from the table.
fn pick(taken: Pose) -> Stage {
    Stage {
        approach_m: 0.10,
        opening_m: OPENING_M,
        gripper: Some(GripperCommand::Close { force_n: GRIP_N }),
        lift_m: 0.25,
        turn_about_closing_deg: Stage::TURN_ABOUT_CLOSING_DEG,
        ..Stage::through("pick", RelativeTo::Object, taken)
    }
}

/// Writes the clouds, then the skill that names them.
fn write(skill: &Skill, path: &Path, cloud: &Cloud, result: &Cloud) -> Result<()> {
    let folder = path.parent().unwrap_or(Path::new("."));
    let text = skill.to_toml(folder)?;
    if let Some(folder) = skill.demonstration.cloud.parent() {
        fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    }
    let results = skill.result.iter().map(|shown| (&shown.cloud, result));
    for (path, cloud) in results.chain([(&skill.demonstration.cloud, cloud)]) {
        let stride = cloud.len().div_ceil(CLOUD_POINTS).max(1);
        let thinned = cloud.points().iter().step_by(stride).copied().collect();
        let thinned = Cloud::new(thinned).unwrap_or_default();
        ply::write_cloud(path, &thinned, Encoding::BinaryLittleEndian)?;
    }
    write_whole(path, text.as_bytes())
        .with_context(|| format!("cannot write {}", path.display()))?;
    console::tell(&format!("wrote {} and {}", path.display(), skill.demonstration.cloud.display()));
    Ok(())
}
