//! Whether a skill fits a robot and a scene: what can be told before anything is seen.

use seeone_core::formats::ply;
use seeone_core::robot::RobotModel;
use seeone_core::{Diagnostic, Pose};
use seeone_plugin::{IkQuery, IkStatus, Kind, Kinematics, PluginError, Setup};
use seeone_runtime::Registry;
use seeone_runtime::files::{RelativeTo, RobotFile, Scene, Skill, Stage, locate};
use seeone_runtime::transfer::{takes, turns};
use std::collections::BTreeMap;
use std::path::Path;

/// A robot with the kinematics by which its reach is known.
pub struct Reach {
    name: String,
    robot: RobotModel,
    kinematics: Box<dyn Kinematics>,
}

impl Reach {
    /// The reach of the robot of a file, with the first kinematics there is.
    ///
    /// # Errors
    /// When the robot or its kinematics cannot be built.
    pub fn of(file: &RobotFile, registry: &Registry) -> Result<Self, Diagnostic> {
        let robot = file.model()?;
        let table = file.config.get(&Kind::Kinematics).cloned().unwrap_or_default();
        let root = Path::new(".");
        let setup = Setup { config: &table, root, seed: 0, robot: Some(&robot), world: None };
        let name = registry.names(Kind::Kinematics).into_iter().next().unwrap_or_default();
        let kinematics = registry.kinematics.build(&name, &setup)?;
        Ok(Self { name: file.name.clone(), robot, kinematics })
    }

    /// Why the robot does not reach a pose in any of the turns that a stage allows; none when it
    /// does.
    fn refusal(&self, pose: &Pose, turn_deg: f64) -> Result<Option<String>, PluginError> {
        let mut nearest: Option<(f64, String)> = None;
        for turn in turns(turn_deg, 0.0) {
            let pose = pose * turn.pose();
            let query = IkQuery::new(&pose, self.robot.home());
            let found = self.kinematics.solve(&self.robot, &query)?;
            if found.status == IkStatus::Solved {
                return Ok(None);
            }
            let off = found.position_error_m + found.rotation_error_rad;
            if nearest.as_ref().is_none_or(|(least, _)| off < *least) {
                nearest = Some((off, found.reason.unwrap_or_else(|| "no posture".into())));
            }
        }
        Ok(nearest.map(|(_, reason)| reason))
    }
}

/// What of a skill's file does not fit: a hand that closes beside its cloud, frames that the scene
/// has not, and poses that the robot does not reach where the scene has them. `targets` are the
/// scene's frames for those of the skill, where a task binds them.
pub fn misfits(
    path: &Path,
    skill: &Skill,
    targets: &BTreeMap<String, String>,
    reach: Option<&Reach>,
    scene: Option<&Scene>,
) -> Vec<Diagnostic> {
    let stages = skill.stages.iter().enumerate();
    let misfits = stages.filter_map(|(index, stage)| {
        let at = |key: &str| locate(path, &["stage", &index.to_string(), key]);
        let pose = match here(skill, stage, targets, scene) {
            Ok(pose) => pose,
            Err(cause) => {
                let (line, column) = at("relative_to");
                let fault = Diagnostic::new("S031", cause).at_line(path, line, column);
                return Some(fault.hint("choose another scene, or bind the frame in a task"));
            }
        };
        let reach = reach?;
        let turn_deg = skill.stages[0].turn_about_closing_deg;
        let why = reach.refusal(&pose, turn_deg).unwrap_or_else(|fault| Some(fault.to_string()));
        let cause = format!("stage {:?} is beyond {}: {}", stage.name, reach.name, why?);
        let (line, column) = at("gripper_pose");
        let fault = Diagnostic::new("S030", cause).at_line(path, line, column);
        Some(fault.hint("choose another robot, or move its base nearer"))
    });
    taken_nothing(path, skill).into_iter().chain(misfits).collect()
}

/// The fault of a demonstration whose hand closes on no point of its cloud; that the cloud cannot be
/// read is told elsewhere.
fn taken_nothing(path: &Path, skill: &Skill) -> Option<Diagnostic> {
    let shown = ply::read_cloud(&skill.demonstration.cloud).ok()?;
    let cause = takes(skill, &shown).err()?;
    let (line, column) = locate(path, &["stage", "0", "gripper_pose"]);
    let fault = Diagnostic::new("S032", cause).at_line(path, line, column);
    Some(fault.hint("cloud and gripper_pose are in `world`, of the moment before the hand closes"))
}

/// The demonstrated pose of a stage where the scene has its frame; where it was shown when there
/// is no scene, or when it moves with the object.
fn here(
    skill: &Skill,
    stage: &Stage,
    targets: &BTreeMap<String, String>,
    scene: Option<&Scene>,
) -> Result<Pose, String> {
    let (RelativeTo::Frame(name), Some(scene)) = (&stage.relative_to, scene) else {
        return Ok(stage.gripper_pose);
    };
    let target = targets.get(name).unwrap_or(name);
    let frame = scene
        .frame(target)
        .ok_or_else(|| format!("scene {:?} has no frame {target:?}", scene.name))?;
    let shown = skill.demonstration.frames[name].inverse() * stage.gripper_pose;
    Ok(frame * shown)
}
