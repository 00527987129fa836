//! What a run is to do, whole and checked.

use crate::files::{Scene, Skill};
use crate::methods::Methods;
use crate::record::pose;
use crate::transfer::takes;
use bevy_ecs::component::Component;
use seeone_core::formats::ply;
use seeone_core::robot::RobotModel;
use seeone_core::{Cloud, Diagnostic, Pose};
use seeone_plugin::Measure;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What a run is to do. The frames that the skill needs are in the scene, and the
/// demonstration's cloud has been read.
#[derive(Component, Clone, Debug)]
pub struct Assignment {
    /// At least one stage.
    pub(super) skill: Skill,
    pub(super) scene: Scene,
    pub(super) robot: RobotModel,
    pub(super) methods: Methods,
    pub(super) demonstration: Cloud,
    /// How the object lay when the demonstration was over, where the skill has it.
    pub(super) result: Option<Cloud>,
    pub(super) frames: BTreeMap<String, Pose>,
    /// The object's name, for the report.
    pub object: String,
    /// The robot file's name, for the report.
    pub robot_name: String,
    /// The seed of the run.
    pub seed: u64,
    /// How often the robot may look and reach for the object, if a try does not come out; one or
    /// more.
    pub tries: usize,
    /// Whether to stop after planning.
    pub dry_run: bool,
    /// Where to write the recording, if at all.
    pub recording: Option<PathBuf>,
    /// What else must be known to repeat the run: versions, hashes of weights.
    pub provenance: BTreeMap<String, String>,
}

impl Assignment {
    /// An assignment with seed 0 that is tried once and not recorded.
    ///
    /// # Errors
    /// `P0xx` when a cloud of the demonstration cannot be read, `M006` when its hand closes on
    /// nothing, `M005` when the skill has no
    /// stage or the scene lacks a frame that it needs.
    pub fn new(
        skill: Skill,
        scene: Scene,
        robot: RobotModel,
        methods: Methods,
    ) -> Result<Self, Diagnostic> {
        Self::bound(skill, scene, robot, methods, &BTreeMap::new())
    }

    /// The same with targets: for a frame of the skill that is in `targets`, the scene's frame
    /// that it stands for; any other stands for the scene's frame of its own name.
    ///
    /// # Errors
    /// As [`Assignment::new`].
    pub fn bound(
        mut skill: Skill,
        scene: Scene,
        robot: RobotModel,
        methods: Methods,
        targets: &BTreeMap<String, String>,
    ) -> Result<Self, Diagnostic> {
        if skill.stages.is_empty() {
            return Err(Diagnostic::new("M005", format!("skill {:?} has no stage", skill.name)));
        }
        let demonstration = ply::read_cloud(&skill.demonstration.cloud)?;
        takes(&skill, &demonstration).map_err(|cause| {
            Diagnostic::new("M006", cause)
                .in_file(&skill.demonstration.cloud)
                .hint("cloud and gripper_pose are in `world`, of the moment before the hand closes")
        })?;
        let result = skill.result.as_ref().map(|shown| ply::read_cloud(&shown.cloud));
        let result = result.transpose()?;
        let mut frames = BTreeMap::new();
        for name in skill.frames() {
            let target = targets.get(name).map_or(name, String::as_str);
            let pose = scene.frame(target).ok_or_else(|| {
                let (skill, scene) = (&skill.name, &scene.name);
                let cause = format!(
                    "skill {skill:?} needs the frame {target:?}, which scene {scene:?} has not"
                );
                Diagnostic::new("M005", cause)
            })?;
            frames.insert(name.to_owned(), pose);
        }
        if let Measure::Held { frame, .. } = &mut skill.measure
            && let Some(target) = targets.get(frame)
        {
            frame.clone_from(target);
        }
        Ok(Self {
            object: scene.object.clone(),
            robot_name: robot.name().to_owned(),
            seed: 0,
            tries: 1,
            dry_run: false,
            recording: None,
            provenance: BTreeMap::new(),
            skill,
            scene,
            robot,
            methods,
            demonstration,
            result,
            frames,
        })
    }

    /// The robot that carries it out.
    pub fn robot(&self) -> &RobotModel {
        &self.robot
    }

    /// Which plugin does what.
    pub fn methods(&self) -> &Methods {
        &self.methods
    }

    /// Everything that is needed to repeat the run, for its recording.
    pub(crate) fn to_json(&self) -> Value {
        // The cloud is named by its file alone: where the files lie is not part of the run.
        let folder = self.skill.demonstration.cloud.parent().unwrap_or(Path::new(""));
        let Scene { name, beside, table, further_hooks, places, camera, drop, .. } = &self.scene;
        let (head, hook) = (self.scene.head(), self.scene.hook());
        json!({
            "skill": self.skill.to_toml(folder).unwrap_or_else(|fault| fault.to_string()),
            "object": self.object,
            "robot": self.robot_name,
            "scene": {
                "name": name,
                "table_height_m": table.height_m,
                "table_friction": table.friction,
                "head": head.map(|head| pose(&head.pose)),
                "head_semi_axes_m": head.map(|head| <[f64; 3]>::from(head.size.semi_axes_m())),
                "head_friction": head.map(|head| head.friction),
                "hook": hook.map(|hook| pose(&hook.pose)),
                "hook_length_m": hook.map(|hook| hook.peg.length_m()),
                "hook_friction": hook.map(|hook| hook.friction),
                "further_hooks": further_hooks.iter().map(|(name, place)| (name, pose(place))).collect::<BTreeMap<_, _>>(),
                "beside": beside.iter().map(|one| json!({ "object": one.object, "centre_xy_m": one.centre.coords.as_slice() })).collect::<Vec<_>>(),
                "places": places.iter().map(|(name, place)| (name, pose(place))).collect::<BTreeMap<_, _>>(),
                "camera": pose(camera),
                "drop_centre_xy_m": drop.centre.coords.as_slice(),
            },
            "seed": self.seed,
            "tries": self.tries,
            "methods": self.methods.iter().map(|(kind, name)| (kind.name(), name)).collect::<BTreeMap<_, _>>(),
            "provenance": self.provenance,
        })
    }
}
