//! A robot: which plugin moves which arm, and what the description of the arm leaves out.

use super::KnownMethods;
use super::codes::{Family, Fault};
use super::exactly::Exactly;
use super::locate::locate;
use super::pose::RawPose;
use super::resolver::Resolver;
use super::source::Source;
use super::spanned::Spanned;
use schemars::JsonSchema;
use seeone_core::robot::{GripperOptions, RobotModel, RobotOptions};
use seeone_core::{Diagnostic, Pose};
use seeone_plugin::Kind;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A robot file: which plugin moves which arm, and what the description of the arm leaves out.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "robot")]
pub(super) struct RawRobot {
    /// The version of the format.
    #[serde(rename = "schema")]
    #[schemars(extend("const" = 1))]
    _schema: u32,
    /// Its name: small letters, digits and hyphens.
    name: Spanned<String>,
    /// The robot plugin that moves it.
    plugin: Spanned<String>,
    /// The URDF below the robot file's folder.
    urdf: Spanned<String>,
    /// Pose of the base link; at the origin when it is not said.
    base: Option<Spanned<RawPose>>,
    /// The URDF's tool link: z along the approach, y along the closing direction.
    tool_link: Option<String>,
    /// Where the robot waits, radians, one a joint.
    home_rad: Option<Spanned<Vec<f64>>>,
    /// What the joints may do.
    #[serde(default)]
    limits: RawLimits,
    /// Pairs of links that no collision check looks at.
    #[serde(default)]
    collision: RawCollision,
    /// The gripper; a DH-Robotics AG-95 when it is not said.
    gripper: Option<RawGripper>,
    /// Tables for plugins, by kind; each plugin checks its own.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, BTreeMap<String, serde_json::Value>>")]
    config: BTreeMap<Spanned<String>, toml::Table>,
}

#[derive(Deserialize, JsonSchema, Default)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "limits")]
struct RawLimits {
    /// Largest acceleration of a joint, radians a second squared.
    #[schemars(range(min = 0.1, max = 100.0))]
    acceleration_rad_s2: Option<Spanned<f64>>,
    /// Largest jerk of a joint, radians a second cubed.
    #[schemars(range(min = 1.0, max = 1e5))]
    jerk_rad_s3: Option<Spanned<f64>>,
}

#[derive(Deserialize, JsonSchema, Default)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "collision")]
struct RawCollision {
    /// Pairs that touch at every posture.
    #[serde(default)]
    always: Vec<Exactly<String, 2>>,
    /// Pairs that touch at no posture.
    #[serde(default)]
    never: Vec<Exactly<String, 2>>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "gripper")]
struct RawGripper {
    /// Smallest and largest grip force, newtons.
    force_n: Spanned<Exactly<f64, 2>>,
    /// `[opening, reach]`, metres, openings rising: how far the finger tips are from the flange
    /// when the pads are that far apart.
    reach_m: Spanned<Vec<Exactly<f64, 2>>>,
}

/// The farthest turn of a joint at home, radians: its limits are the URDF's.
const FARTHEST_RAD: f64 = 100.0;
/// The strongest gripper, newtons, and its longest fingers and widest opening, metres.
const STRONGEST_N: f64 = 1000.0;
const LONGEST_M: f64 = 1.0;

/// A robot file. The arm itself is checked when [`RobotFile::model`] reads it.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotFile {
    /// Where it was read.
    pub path: PathBuf,
    /// Its name.
    pub name: String,
    /// The robot plugin that moves it.
    pub plugin: String,
    /// The description of the arm.
    pub urdf: PathBuf,
    /// What the description leaves out: base pose, tool link, home, limits, gripper.
    pub options: RobotOptions,
    /// Tables of configuration by plugin kind, e.g. `[config.motion]`; each plugin checks
    /// its own.
    pub config: BTreeMap<Kind, toml::Table>,
}

impl RobotFile {
    /// Reads and checks a robot file.
    ///
    /// # Errors
    /// Every fault found, codes `B0xx`.
    pub fn read(path: &Path, known: &KnownMethods) -> Result<Self, Vec<Diagnostic>> {
        let source = Source::open(Family::Robot, path).map_err(|fault| vec![fault])?;
        let raw: RawRobot = source.parse()?;
        let mut resolver = Resolver::new(&source);
        let name = raw.plugin.get_ref();
        if let Some(known) = known.get(&Kind::Robot)
            && !known.contains(name)
        {
            let cause = format!("there is no robot plugin {name:?}");
            let fault = source.fault(Fault::Reference, raw.plugin.span(), cause);
            resolver.note(fault.suggest(name, known.iter().map(String::as_str)));
        }
        let file = Self {
            path: path.to_owned(),
            name: resolver.name("name", &raw.name),
            plugin: name.clone(),
            urdf: resolver.file("urdf", &raw.urdf),
            config: config(&mut resolver, &raw.config),
            options: options(&mut resolver, raw),
        };
        resolver.finish(file)
    }

    /// The robot that the file describes.
    ///
    /// # Errors
    /// `R0xx` when the description, or an option of this file against it, is wrong.
    pub fn model(&self) -> Result<RobotModel, Diagnostic> {
        // What this file says of the arm is told at its own key.
        let told = |fault: Diagnostic| {
            let key = match fault.code {
                "R010" => "tool_link",
                "R013" => "home_rad",
                "R014" => "gripper",
                "R015" => "limits",
                "R016" => "collision",
                _ => return fault,
            };
            match locate(&self.path, &[key]) {
                // The key is not there: the fault is the description's own.
                (1, 1) => fault,
                (line, column) => fault.at_line(&self.path, line, column),
            }
        };
        RobotModel::from_urdf(&self.urdf, &self.options).map_err(told)
    }
}

fn options(resolver: &mut Resolver, raw: RawRobot) -> RobotOptions {
    let default = RobotOptions::default();
    let acceleration = raw.limits.acceleration_rad_s2.as_ref();
    let jerk = raw.limits.jerk_rad_s3.as_ref();
    RobotOptions {
        base: raw.base.as_ref().map_or_else(Pose::identity, |pose| resolver.pose("base", pose)),
        tool_link: raw.tool_link.unwrap_or(default.tool_link),
        home: raw.home_rad.map(|home| {
            for position in home.get_ref() {
                let position = Spanned::new(home.span(), *position);
                resolver.number("home_rad", &position, -FARTHEST_RAD..=FARTHEST_RAD);
            }
            home.into_inner()
        }),
        acceleration: resolver.number_or(
            "acceleration_rad_s2",
            acceleration,
            default.acceleration,
            0.1..=100.0,
        ),
        jerk: resolver.number_or("jerk_rad_s3", jerk, default.jerk, 1.0..=1e5),
        unchecked_pairs: [raw.collision.always, raw.collision.never]
            .into_iter()
            .flatten()
            .map(|Exactly(pair)| pair)
            .collect(),
        gripper: raw.gripper.map_or(default.gripper, |gripper| GripperOptions {
            force_n: resolver.numbers("force_n", &gripper.force_n, 0.0..=STRONGEST_N),
            reach_m: reach(resolver, &gripper.reach_m),
        }),
    }
}

fn reach(resolver: &mut Resolver, raw: &Spanned<Vec<Exactly<f64, 2>>>) -> Vec<(f64, f64)> {
    let mut entry = |entry: &Exactly<f64, 2>| {
        let entry = Spanned::new(raw.span(), *entry);
        resolver.numbers("reach_m", &entry, 0.0..=LONGEST_M).into()
    };
    raw.get_ref().iter().map(&mut entry).collect()
}

fn config(
    resolver: &mut Resolver,
    raw: &BTreeMap<Spanned<String>, toml::Table>,
) -> BTreeMap<Kind, toml::Table> {
    let mut config = BTreeMap::new();
    for (key, table) in raw {
        match key.get_ref().parse::<Kind>() {
            Ok(kind) => {
                config.insert(kind, table.clone());
            }
            Err(()) => {
                let cause = format!("there is no plugin kind \"{}\"", key.get_ref());
                let fault = resolver.source.fault(Fault::UnknownKey, key.span(), cause);
                resolver.note(fault.suggest(key.get_ref(), Kind::ALL.map(Kind::name)));
            }
        }
    }
    config
}
