//! A scene: what stands where, and which object lies on the table.

use nalgebra::{Point2, Point3, Vector2};
use seeone_core::pose::PoseFields;
use seeone_core::robot::Solid;
use seeone_core::{HeadSize, Intrinsics, Pose};
use seeone_plugin::motion::Obstacle;
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

/// Where objects are dropped and looked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drop {
    /// Middle of the zone in `world`, metres.
    pub centre: Point2<f64>,
    /// Half the sides of the box in which the target is looked for, metres.
    pub half_extents_m: Vector2<f64>,
    /// Height of that box above the table, metres.
    pub crop_height_m: f64,
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
    /// The head.
    pub head: Head,
    /// The camera plugin, where the scene asks for one.
    pub camera_plugin: Option<String>,
    /// A recorded cloud, for a camera plugin that shows one.
    pub camera_cloud: Option<PathBuf>,
    /// The camera's frame in `world`: x right, y down, z forward.
    pub camera: Pose,
    /// The camera's intrinsics.
    pub intrinsics: Intrinsics,
    /// The drop zone.
    pub drop: Drop,
    /// What else the arm must not touch, e.g. the camera's stand; poses in `world`.
    pub standing: Vec<Solid>,
}

impl Scene {
    /// The pose in `world` of a frame that a skill may refer to.
    pub fn frame(&self, name: &str) -> Option<Pose> {
        (name == "head").then_some(self.head.pose)
    }

    /// What the arm must not touch.
    pub fn obstacles(&self) -> Vec<Obstacle> {
        let mut obstacles = vec![
            Obstacle::Table { height_m: self.table.height_m, soft_m: self.table.soft_m },
            Obstacle::Ellipsoid {
                name: "head".into(),
                centre: Point3::from(self.head.pose.translation.vector),
                rotation: self.head.pose.rotation,
                semi_axes_m: self.head.size.semi_axes_m(),
            },
        ];
        obstacles.extend(self.standing.iter().cloned().map(Obstacle::Solid));
        obstacles
    }

    /// The table of configuration from which the camera plugin is built: `pose`,
    /// `intrinsics`, and `crop` with `centre_xy_m`, `half_extents_m`, `floor_m` and
    /// `height_m`, the box in `world` that holds the target; `cloud` where the file has it.
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
        let crop = table(vec![
            ("centre_xy_m", floats(self.drop.centre.coords.as_slice())),
            ("half_extents_m", floats(self.drop.half_extents_m.as_slice())),
            ("floor_m", self.table.height_m.into()),
            ("height_m", self.drop.crop_height_m.into()),
        ]);
        let mut camera = table(vec![
            ("pose", pose.into()),
            ("intrinsics", intrinsics.into()),
            ("crop", crop.into()),
        ]);
        if let Some(cloud) = &self.camera_cloud {
            camera.insert("cloud".into(), cloud.to_string_lossy().into_owned().into());
        }
        camera
    }
}
