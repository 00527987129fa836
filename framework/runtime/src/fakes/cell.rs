//! A cell with a fake cap on its table, and the files and plugins of a run in it.

use super::solvers::{FakeEncoding, FakeKinematics, FakeMotion, FakePerception, FakeTransfer};
use super::{LeastSquares, canonical_cloud};
use crate::files::{
    Demonstration, Drop, Head, RelativeTo, RobotFile, Scene, ShownResult, Skill, Stage, Table,
    Targets,
};
use crate::methods::Methods;
use crate::plugins::Plugins;
use crate::registry::Registry;
use crate::run::Assignment;
use crate::transfer::ANCHOR;
use nalgebra::{Point2, Point3, Translation3, UnitQuaternion, Vector2, Vector3};
use seeone_core::formats::ply::{Encoding, write_cloud};
use seeone_core::robot::RobotOptions;
use seeone_core::{Cloud, HeadSize, Intrinsics, Pose, Similarity};
use seeone_plugin::{
    Action, Camera, Felt, GripperCommand, Judge, Measure, Observation, PluginError, Robot,
    RobotSample, RobotState, Verdict, Watch,
};
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// What goes wrong in a fake cell.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Behaviour {
    /// The step in which a plugin fails.
    pub(crate) fails: Option<&'static str>,
    /// Whether it panics then.
    pub(crate) panics: bool,
    /// The stage that no plan reaches.
    pub(crate) unreachable: Option<&'static str>,
    /// How many plans are refused before one that would do is made.
    pub(crate) refuses: usize,
    /// The stage that no plan reaches that does not begin with the first.
    pub(crate) blocks_after: Option<&'static str>,
    /// How many times the gripper closes on nothing.
    pub(crate) misses: usize,
    /// Whether the object falls after the grip.
    pub(crate) drops: bool,
    /// Whether what is in the hand touches something on the way.
    pub(crate) touches: bool,
    /// Whether it is pushed out of the hand by that.
    pub(crate) slips: bool,
    /// Whether nothing is in sight.
    pub(crate) blind: bool,
    /// Whether the hand holds something from the first.
    pub(crate) holds: bool,
    /// Whether it ends badly although nothing failed.
    pub(crate) spoils: bool,
    /// Whether nothing is in sight any more once the hand closed.
    pub(crate) clears: bool,
    /// How many times what is let go falls back to where it lay.
    pub(crate) falls: usize,
    /// By how much what is let go at its place leans the first time, degrees.
    pub(crate) leans_deg: f64,
}

pub(super) fn broken(behaviour: &Behaviour, step: &str) -> Result<(), PluginError> {
    let fails = behaviour.fails == Some(step);
    assert!(!(fails && behaviour.panics), "broken {step}");
    if fails { Err(PluginError::Internal(format!("broken {step}"))) } else { Ok(()) }
}

struct FakeCamera {
    behaviour: Behaviour,
    lying: Cloud,
    leaning: Cloud,
    worn: Cloud,
    closed: Moved,
    releases: Releases,
}

impl Camera for FakeCamera {
    fn observe(&mut self) -> Result<Observation, PluginError> {
        let Self { behaviour, lying, leaning, worn, .. } = self;
        broken(behaviour, "observe")?;
        let cleared = behaviour.clears && self.closed.load(Ordering::Relaxed);
        let stays = self.releases.load(Ordering::Relaxed).checked_sub(behaviour.falls);
        let cloud = match stays {
            _ if behaviour.blind || cleared => Cloud::default(),
            None | Some(0) => lying.clone(),
            Some(1) => leaning.clone(),
            Some(_) => worn.clone(),
        };
        Ok(Observation { depth: None, cloud, camera_position: Point3::new(0.9, -0.4, 0.6) })
    }
}

/// Whether the robot ever moved, for the judge to see; or ever closed its hand, for the camera.
type Moved = Arc<AtomicBool>;
/// How often the robot let go of something it held.
type Releases = Arc<AtomicUsize>;

struct FakeRobot {
    behaviour: Behaviour,
    time_s: f64,
    opening_m: f64,
    holding: bool,
    moved: Moved,
    closed: Moved,
    releases: Releases,
}

impl Robot for FakeRobot {
    fn state(&mut self) -> Result<RobotState, PluginError> {
        Ok(RobotState { joints: vec![0.1], opening_m: self.opening_m })
    }

    fn execute(&mut self, action: &Action, watch: &mut Watch) -> Result<Felt, PluginError> {
        broken(&self.behaviour, "act")?;
        self.moved.store(true, Ordering::Relaxed);
        match action {
            Action::Grip(GripperCommand::Close { .. }) => {
                self.closed.store(true, Ordering::Relaxed);
                self.holding = self.behaviour.misses == 0;
                self.behaviour.misses = self.behaviour.misses.saturating_sub(1);
                self.opening_m = if self.holding { 0.003 } else { 0.0 };
            }
            Action::Grip(GripperCommand::Open { opening_m }) => {
                self.releases.fetch_add(usize::from(self.holding), Ordering::Relaxed);
                self.holding = false;
                self.opening_m = *opening_m;
            }
            Action::Move(_) | Action::MoveUntilContact { .. } => {
                self.holding &= !self.behaviour.drops;
            }
        }
        let state = self.state()?;
        for _ in 0..30 {
            self.time_s += 1.0 / 30.0;
            watch(&RobotSample { time_s: self.time_s, state: state.clone() })?;
        }
        let contact = matches!(action, Action::MoveUntilContact { .. }) && self.behaviour.touches;
        self.holding &= !(contact && self.behaviour.slips);
        Ok(Felt { opening_m: self.opening_m, holding: self.holding, contact })
    }

    fn stop(&mut self) -> Result<(), PluginError> {
        broken(&self.behaviour, "stop")
    }
}

struct FakeJudge(Behaviour, Moved);

impl Judge for FakeJudge {
    fn grasped(&mut self) -> Result<bool, PluginError> {
        Ok(true)
    }

    fn judge(&mut self, _: &Measure, grasped: bool) -> Result<Verdict, PluginError> {
        broken(&self.0, "judge")?;
        let success = grasped && self.1.load(Ordering::Relaxed) && !self.0.spoils;
        Ok(Verdict {
            grasped,
            success,
            error_m: Some(0.01),
            error_d: Some(0.04),
            reason: if success { "worn within 0.04 d" } else { "it lies on the table" }.into(),
            ..Verdict::default()
        })
    }

    fn object(&self) -> Vec<[f64; 3]> {
        vec![[0.123456789, 0.0, 0.5]; 3]
    }
}

/// A cell in a temporary folder.
pub(crate) struct FakeCell {
    pub(crate) folder: tempfile::TempDir,
    /// Canonical -> world of the demonstrated object and of the one on the table.
    pub(crate) placed: [Similarity; 2],
    pub(crate) skill: Skill,
    pub(crate) scene: Scene,
}

/// One revolute joint with a gripper: what a robot model must at least have.
const URDF: &str = r#"<robot name="fake"><link name="base"/><link name="arm"/><link name="tcp"/>
<link name="palm"/><link name="left"/><link name="right"/>
<joint name="turn" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
<limit lower="-3" upper="3" velocity="3" effort="1"/></joint>
<joint name="hand" type="fixed"><parent link="arm"/><child link="palm"/></joint>
<joint name="tip" type="fixed"><parent link="palm"/><child link="tcp"/></joint>
<joint name="l" type="prismatic"><parent link="palm"/><child link="left"/><axis xyz="0 1 0"/>
<limit lower="0" upper="0.04" velocity="1" effort="1"/></joint>
<joint name="r" type="prismatic"><parent link="palm"/><child link="right"/><axis xyz="0 -1 0"/>
<limit lower="0" upper="0.04" velocity="1" effort="1"/></joint></robot>"#;

fn similarity(xyz: [f64; 3], turn: [f64; 3], scale: f64) -> Similarity {
    let rotation = UnitQuaternion::from_scaled_axis(Vector3::from(turn));
    Similarity::from_parts(Translation3::from(Vector3::from(xyz)), rotation, scale)
}

impl FakeCell {
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let placed = [
            similarity([0.4, -0.2, 0.1], [0.3, 0.2, 1.0], 0.27),
            similarity([0.5, -0.1, 0.05], [-0.2, 0.4, -2.0], 0.29),
        ];
        let cloud = folder.path().join("demonstration.ply");
        let shown = Cloud::new(canonical_cloud(&placed[0]).points).unwrap();
        write_cloud(&cloud, &shown, Encoding::BinaryLittleEndian).unwrap();
        let head = Pose::translation(0.35, 0.4, 0.28);
        let moved_head = Pose::translation(0.1, 0.5, 0.3);
        let skill = Skill {
            name: "cap-wearing".into(),
            category: "cap".into(),
            summary: String::new(),
            demonstration: Demonstration {
                cloud,
                camera_position: Point3::new(0.9, -0.4, 0.6),
                frames: [("head".to_owned(), head)].into(),
            },
            stages: vec![
                stage("pick", RelativeTo::Object, grasp(&placed[0])),
                stage("release", RelativeTo::Frame("head".into()), release(&head)),
            ],
            methods: BTreeMap::new(),
            result: None,
            measure: Measure::Worn { tolerance_d: 0.1 },
        };
        Self { folder, placed, skill, scene: scene(moved_head) }
    }

    /// The same cell with a skill whose result was shown, too: the cap worn level.
    pub(crate) fn with_result() -> Self {
        let mut cell = Self::new();
        let path = cell.folder.path().join("result.ply");
        let worn = worn_on(&cell.skill.demonstration.frames["head"], 0.27);
        let shown = Cloud::new(canonical_cloud(&worn).points).unwrap();
        write_cloud(&path, &shown, Encoding::BinaryLittleEndian).unwrap();
        let frame = "head".to_owned();
        let result = ShownResult { cloud: path, frame, within_m: 0.02, within_deg: 5.0 };
        cell.skill.result = Some(result);
        cell
    }

    pub(crate) fn assignment(&self) -> Assignment {
        let urdf = self.folder.path().join("fake.urdf");
        fs::write(&urdf, URDF).unwrap();
        let file = robot_file(urdf);
        let robot = file.model().unwrap();
        let methods = Methods::resolve(&self.skill, &self.scene, &file, &[], &registry()).unwrap();
        Assignment::new(self.skill.clone(), self.scene.clone(), robot, methods).unwrap()
    }

    pub(crate) fn plugins(&self, behaviour: Behaviour) -> Plugins {
        let (moved, closed) = (Moved::default(), Moved::default());
        let releases = Releases::default();
        let cloud = |placed: &Similarity| Cloud::new(canonical_cloud(placed).points).unwrap();
        let head = self.scene.head().map_or(Pose::identity(), |head| head.pose);
        Plugins {
            camera: Box::new(FakeCamera {
                behaviour,
                lying: cloud(&self.placed[1]),
                leaning: cloud(&worn_on(&(head * leaning(behaviour.leans_deg)), 0.29)),
                worn: cloud(&worn_on(&head, 0.29)),
                closed: closed.clone(),
                releases: releases.clone(),
            }),
            perception: Box::new(FakePerception(behaviour)),
            encoding: Box::new(FakeEncoding(behaviour)),
            alignment: Box::new(LeastSquares),
            transfer: Box::new(FakeTransfer(behaviour)),
            kinematics: Box::new(FakeKinematics),
            motion: Box::new(FakeMotion(behaviour, AtomicUsize::new(0))),
            robot: Box::new(FakeRobot {
                behaviour,
                time_s: 2.0,
                opening_m: 0.03,
                holding: behaviour.holds,
                moved: moved.clone(),
                closed,
                releases,
            }),
            judge: Some(Box::new(FakeJudge(behaviour, moved))),
        }
    }
}

/// The visor between the pads, the hand coming from the front.
fn grasp(placed: &Similarity) -> Pose {
    let tip = Point3::new(0.5, 0.95, 0.35);
    let rotation = placed.isometry.rotation
        * seeone_core::pose::rotation_from_approach(&-Vector3::y(), &Vector3::z());
    Pose::from_parts(Translation3::from((placed * tip).coords), rotation)
}

/// The same grasp with the cap worn level on the head.
fn release(head: &Pose) -> Pose {
    grasp(&worn_on(head, 0.27))
}

/// A lean about a head's x, as it is seen in its frame.
pub(crate) fn leaning(degrees: f64) -> Pose {
    Pose::rotation(Vector3::x() * degrees.to_radians())
}

/// A cap of `scale` metres a canonical unit, worn level on the head: canonical -> `world`.
fn worn_on(head: &Pose, scale: f64) -> Similarity {
    let back = Vector3::new(-0.135, -0.135, -0.07) + ANCHOR.coords * 0.27;
    let origin = back - ANCHOR.coords * scale;
    Similarity::from_isometry(*head, 1.0) * similarity(origin.into(), [0.0; 3], scale)
}

fn stage(name: &str, relative_to: RelativeTo, gripper_pose: Pose) -> Stage {
    let first = relative_to == RelativeTo::Object;
    Stage {
        approach_m: 0.1,
        gripper: Some(if first {
            GripperCommand::Close { force_n: 20.0 }
        } else {
            GripperCommand::Open { opening_m: 0.06 }
        }),
        retreat_m: if first { 0.0 } else { 0.15 },
        lift_m: if first { 0.25 } else { 0.0 },
        turn_about_closing_deg: 90.0,
        ..Stage::through(name, relative_to, gripper_pose)
    }
}

fn scene(head: Pose) -> Scene {
    Scene {
        name: "head".into(),
        object: "fake-cap".into(),
        beside: Vec::new(),
        table: Table { height_m: 0.0, soft_m: 0.03, friction: 0.6 },
        targets: Targets::Head(Head { pose: head, size: HeadSize::MEDIUM, friction: 0.5 }),
        further_hooks: BTreeMap::new(),
        places: BTreeMap::new(),
        camera_plugin: None,
        camera_cloud: None,
        camera_by_colour: false,
        camera: Pose::identity(),
        intrinsics: Intrinsics { width: 64, height: 48, fx: 38.0, fy: 38.0, cx: 31.5, cy: 23.5 },
        drop: Drop {
            centre: Point2::new(0.45, -0.15),
            half_extents_m: Vector2::new(0.25, 0.25),
            crop_height_m: 0.3,
            apart_m: None,
        },
        standing: Vec::new(),
    }
}

pub(crate) fn robot_file(urdf: PathBuf) -> RobotFile {
    RobotFile {
        path: "fake.toml".into(),
        name: "fake".into(),
        plugin: "fake".into(),
        urdf,
        options: RobotOptions::default(),
        config: BTreeMap::new(),
    }
}

/// A registry with one fake of each kind, by name alone.
pub(crate) fn registry() -> Registry {
    let mut registry = Registry::new();
    let none = || PluginError::Configuration("a fake is not built".into());
    registry.camera.add("fake", move |_| Err(none()));
    registry.perception.add("fake", move |_| Err(none()));
    registry.encoding.add("fake", move |_| Err(none()));
    registry.alignment.add("fake", move |_| Err(none()));
    registry.transfer.add("fake", move |_| Err(none()));
    registry.kinematics.add("fake", move |_| Err(none()));
    registry.motion.add("fake", move |_| Err(none()));
    registry.robot.add("fake", move |_| Err(none()));
    registry
}
