//! A scene: what stands where, and which object lies on the table.

use nalgebra::{Point2, Point3, Translation3, Vector2, Vector3};
use seeone_core::hook::PEG_BALL_RADIUS_M;
use seeone_core::pose::PoseFields;
use seeone_core::robot::{Shape, Solid};
use seeone_core::{HeadSize, Intrinsics, Peg, Pose};
use seeone_plugin::motion::Obstacle;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The table, whose top is a soft mat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Table {
    /// Top of the mat, metres above the world's origin.
    pub height_m: f64,
    /// How far the robot may sink into the mat, metres.
    pub soft_m: f64,
    /// Coulomb friction of the mat.
    pub friction: f64,
}

/// The head: z up, +y where the face looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Head {
    /// Its frame in `world`.
    pub pose: Pose,
    /// How large it is.
    pub size: HeadSize,
    /// Coulomb friction of its surface.
    pub friction: f64,
}

/// A hook: a wooden peg on an upright wall, which reaches as far as anything does. Its
/// frame: the origin where the peg leaves the wall, y out of the wall, z up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hook {
    /// Its frame in `world`.
    pub pose: Pose,
    /// How long it is.
    pub peg: Peg,
    /// Coulomb friction of peg and wall.
    pub friction: f64,
}

/// What objects are brought to: at least one thing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Targets {
    /// A head alone.
    Head(Head),
    /// A hook alone.
    Hook(Hook),
    /// Both.
    Both(Head, Hook),
}

/// Where objects are dropped and looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drop {
    /// Middle of the zone in `world`, metres.
    pub centre: Point2<f64>,
    /// Half the sides of the box in which the target is looked for, metres.
    pub half_extents_m: Vector2<f64>,
    /// Height of that box above the table, metres.
    pub crop_height_m: f64,
    /// Where several objects may lie in it: each is farther from the others than so many metres.
    pub apart_m: Option<f64>,
}

/// A further object that lies there from the start.
#[derive(Clone, Debug, PartialEq)]
pub struct Beside {
    /// Its name, or the name of a set to draw from.
    pub object: String,
    /// Where it is dropped, `world`, metres.
    pub centre: Point2<f64>,
}

/// A scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Its name.
    pub name: String,
    /// The object that lies there: its name, or the name of a set to draw from.
    pub object: String,
    /// The table.
    pub table: Table,
    /// Further objects; none in a scene with a head.
    pub beside: Vec<Beside>,
    /// What objects are brought to.
    pub targets: Targets,
    /// Where further hooks like the one among the targets are, by name.
    pub further_hooks: BTreeMap<String, Pose>,
    /// Further frames by name, e.g. where a person takes things; none is `object`, `head` or
    /// `hook`.
    pub places: BTreeMap<String, Pose>,
    /// The camera plugin, where the scene asks for one.
    pub camera_plugin: Option<String>,
    /// A recorded cloud, for a camera plugin that shows one.
    pub camera_cloud: Option<PathBuf>,
    /// Whether the camera tells the object by its colour, wherever it is in the picture, and not
    /// as what lies in the box of the drop zone.
    pub camera_by_colour: bool,
    /// The camera's frame in `world`: x right, y down, z forward.
    pub camera: Pose,
    /// The camera's intrinsics.
    pub intrinsics: Intrinsics,
    /// The drop zone.
    pub drop: Drop,
    /// What else the arm must not touch, e.g. the camera's stand; poses in `world`.
    pub standing: Vec<Solid>,
}

/// Half the edges of the box that stands for a wall, metres: beyond what any arm reaches.
const WALL_HALF_M: Vector3<f64> = Vector3::new(3.0, 0.05, 3.0);

impl Hook {
    /// The peg, as thick as its end ball, and the wall behind it in `world`.
    fn solids(&self) -> [Solid; 2] {
        let peg = Shape::Capsule { radius_m: PEG_BALL_RADIUS_M, length_m: self.peg.length_m() };
        let wall = Shape::Box { half_m: WALL_HALF_M };
        let behind = Translation3::new(0.0, -WALL_HALF_M.y, 0.0);
        let solid = |part: &str, shape, pose| Solid { part: part.into(), shape, pose };
        [
            solid("peg", peg, self.pose * Peg::along(self.peg.length_m() / 2.0)),
            solid("wall", wall, self.pose * behind),
        ]
    }
}

impl Scene {
    /// The head, where there is one.
    pub fn head(&self) -> Option<&Head> {
        match &self.targets {
            Targets::Head(head) | Targets::Both(head, _) => Some(head),
            Targets::Hook(_) => None,
        }
    }

    /// The hook, where there is one.
    pub fn hook(&self) -> Option<&Hook> {
        match &self.targets {
            Targets::Hook(hook) | Targets::Both(_, hook) => Some(hook),
            Targets::Head(_) => None,
        }
    }

    /// What lies there, each by its name or that of a set.
    pub fn objects(&self) -> Vec<&str> {
        let beside = self.beside.iter().map(|one| one.object.as_str());
        [self.object.as_str()].into_iter().chain(beside).collect()
    }

    /// Every hook, that of the targets first.
    pub fn hooks(&self) -> Vec<Hook> {
        let Some(first) = self.hook() else { return Vec::new() };
        let further = self.further_hooks.values().map(|pose| Hook { pose: *pose, ..*first });
        [*first].into_iter().chain(further).collect()
    }

    /// The pose in `world` of a frame that a skill may refer to: `head`, `hook`, a further hook
    /// or a place that the scene names.
    pub fn frame(&self, name: &str) -> Option<Pose> {
        match name {
            "head" => self.head().map(|head| head.pose),
            "hook" => self.hook().map(|hook| hook.pose),
            _ => self.further_hooks.get(name).or_else(|| self.places.get(name)).copied(),
        }
    }

    /// What the arm must not touch.
    pub fn obstacles(&self) -> Vec<Obstacle> {
        let Table { height_m, soft_m, .. } = self.table;
        let head = self.head().map(|head| Obstacle::Ellipsoid {
            name: "head".into(),
            centre: Point3::from(head.pose.translation.vector),
            rotation: head.pose.rotation,
            semi_axes_m: head.size.semi_axes_m(),
        });
        let hooks = self.hooks();
        let hooks = hooks.iter().flat_map(Hook::solids);
        let solids = hooks.chain(self.standing.iter().cloned()).map(Obstacle::Solid);
        [Obstacle::Table { height_m, soft_m }].into_iter().chain(head).chain(solids).collect()
    }

    /// The table of configuration from which the camera plugin is built: `pose`,
    /// `intrinsics`, and `crop` with `centre_xy_m`, `half_extents_m`, `floor_m` and
    /// `height_m`, the box in `world` that holds the target, with `apart_m` where it may hold
    /// several; `by_colour` and `cloud` where the file has them.
    pub fn camera_table(&self) -> toml::Table {
        let pose = PoseFields::from(&self.camera);
        let lens = &self.intrinsics;
        let floats = |values: &[f64]| toml::Value::from(values.to_vec());
        let table = |entries: Vec<(&str, toml::Value)>| -> toml::Table {
            entries.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
        };
        let pose =
            table(vec![("xyz_m", floats(&pose.xyz_m)), ("quat_xyzw", floats(&pose.quat_xyzw))]);
        let intrinsics = table(vec![
            ("width", toml::Value::Integer(lens.width as i64)),
            ("height", toml::Value::Integer(lens.height as i64)),
            ("fx", lens.fx.into()),
            ("fy", lens.fy.into()),
            ("cx", lens.cx.into()),
            ("cy", lens.cy.into()),
        ]);
        let mut crop = table(vec![
            ("centre_xy_m", floats(self.drop.centre.coords.as_slice())),
            ("half_extents_m", floats(self.drop.half_extents_m.as_slice())),
            ("floor_m", self.table.height_m.into()),
            ("height_m", self.drop.crop_height_m.into()),
        ]);
        if let Some(apart_m) = self.drop.apart_m {
            crop.insert("apart_m".into(), apart_m.into());
        }
        let mut camera = table(vec![
            ("pose", pose.into()),
            ("intrinsics", intrinsics.into()),
            ("crop", crop.into()),
        ]);
        if self.camera_by_colour {
            camera.insert("by_colour".into(), true.into());
        }
        if let Some(cloud) = &self.camera_cloud {
            camera.insert("cloud".into(), cloud.to_string_lossy().into_owned().into());
        }
        camera
    }
}
