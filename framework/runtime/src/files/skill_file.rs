//! Reading a skill.

use super::codes::{Family, Fault};
use super::exactly::Exactly;
use super::measure::{RawSuccess, measure};
use super::pose::RawPose;
use super::resolver::Resolver;
use super::shown_result::{RawResult, shown_result};
use super::source::Source;
use super::spanned::Spanned;
use super::{Demonstration, KnownMethods, RelativeTo, Skill, Stage};
use nalgebra::Point3;
use schemars::JsonSchema;
use seeone_core::Diagnostic;
use seeone_plugin::{GripperCommand, Kind};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::path::Path;

/// A skill file: one demonstration of one manipulation.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "skill")]
pub(super) struct RawSkill {
    /// The version of the format.
    #[serde(rename = "schema")]
    #[schemars(extend("const" = 1))]
    _schema: u32,
    /// Its name: small letters, digits and hyphens.
    name: Spanned<String>,
    /// The category of objects it is for.
    category: Spanned<String>,
    /// What it does, in a sentence.
    #[serde(default)]
    summary: String,
    /// What was seen when the skill was shown.
    demonstration: RawDemonstration,
    /// The key poses, in order; the first is relative to the object.
    #[serde(default)]
    stage: Vec<Spanned<RawStage>>,
    /// Plugins by kind, where the skill asks for one.
    #[serde(default)]
    methods: BTreeMap<Spanned<String>, Spanned<String>>,
    /// What the robot looks for itself when it is done; left out, it does not look again.
    result: Option<RawResult>,
    /// What counts as success.
    success: RawSuccess,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "demonstration")]
struct RawDemonstration {
    /// A PLY file below the skill's folder: the object's points in `world`, metres, before the
    /// first stage.
    cloud: Spanned<String>,
    /// Where the camera stood in `world`, metres.
    camera_xyz_m: Spanned<Exactly<f64, 3>>,
    /// Poses in `world` of the frames that stages are relative to, by name.
    #[serde(default)]
    frames: BTreeMap<Spanned<String>, Spanned<RawPose>>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "stage")]
struct RawStage {
    /// Its name, unique in the skill.
    name: Spanned<String>,
    /// What the pose moves with: `object`, or a frame of the demonstration.
    relative_to: Spanned<String>,
    /// The demonstrated tool frame in `world`.
    gripper_pose: Spanned<RawPose>,
    /// Straight approach along the tool's z, metres; 0 when it is not said.
    #[schemars(range(min = 0.0, max = LONGEST_LINE_M))]
    approach_m: Option<Spanned<f64>>,
    /// Opening of the fingers while approaching, metres; 0.03 when it is not said.
    #[schemars(range(min = 0.0, max = WIDEST_M))]
    opening_m: Option<Spanned<f64>>,
    /// The line to the pose ends where the load at the wrist has changed by this, newtons.
    #[schemars(range(min = *CONTACT_N.start(), max = *CONTACT_N.end()))]
    until_contact_n: Option<Spanned<f64>>,
    /// What the gripper does at the pose.
    gripper: Option<Spanned<RawGripper>>,
    /// Straight retreat against the tool's z, metres; 0 when it is not said.
    #[schemars(range(min = 0.0, max = LONGEST_LINE_M))]
    retreat_m: Option<Spanned<f64>>,
    /// Straight lift along the world's z, metres; 0 when it is not said.
    #[schemars(range(min = 0.0, max = LONGEST_LINE_M))]
    lift_m: Option<Spanned<f64>>,
    /// By how much the grasp may be turned about the closing axis, degrees either way; 90 when it
    /// is not said.
    #[schemars(range(min = 0.0, max = 180.0))]
    turn_about_closing_deg: Option<Spanned<f64>>,
    /// Where contact has ended a line before this stage: whether the hand then makes the motion that
    /// was shown from the pose before to this one, instead of going to the pose itself; `false` when
    /// it is not said.
    #[serde(default)]
    onward: bool,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "gripper_command")]
struct RawGripper {
    /// Close with this force, newtons.
    #[schemars(range(min = 0.0, max = STRONGEST_N))]
    close_n: Option<Spanned<f64>>,
    /// Open to this distance between the pads, metres.
    #[schemars(range(min = 0.0, max = WIDEST_M))]
    open_m: Option<Spanned<f64>>,
}

/// The longest straight line a stage may ask for, metres.
const LONGEST_LINE_M: f64 = 0.5;
/// The widest gripper opening a stage may ask for, metres.
const WIDEST_M: f64 = 0.2;
/// The forces of contact that a stage may ask for, newtons: more than nothing, and what may be
/// pushed with.
const CONTACT_N: RangeInclusive<f64> = 1.0..=50.0;
/// The largest grip force a stage may ask for, newtons.
const STRONGEST_N: f64 = 200.0;
/// The farthest coordinate of a camera, metres.
const FARTHEST_M: f64 = 10.0;

impl Skill {
    /// Reads and checks a skill; the cloud it names must exist but is not read.
    ///
    /// # Errors
    /// Every fault found, codes `S0xx`.
    pub fn read(path: &Path, known: &KnownMethods) -> Result<Self, Vec<Diagnostic>> {
        let source = Source::open(Family::Skill, path).map_err(|fault| vec![fault])?;
        let raw: RawSkill = source.parse()?;
        let mut resolver = Resolver::new(&source);
        let demonstration = demonstration(&mut resolver, &raw.demonstration);
        let skill = Skill {
            name: resolver.name("name", &raw.name),
            category: resolver.name("category", &raw.category),
            summary: raw.summary,
            stages: stages(&mut resolver, &raw.stage, &demonstration),
            methods: methods(&mut resolver, &raw.methods, known),
            result: raw.result.as_ref().map(|raw| shown_result(&mut resolver, raw, &demonstration)),
            measure: measure(&mut resolver, &raw.success, &demonstration),
            demonstration,
        };
        resolver.finish(skill)
    }
}

fn demonstration(resolver: &mut Resolver, raw: &RawDemonstration) -> Demonstration {
    let mut frames = BTreeMap::new();
    for (name, pose) in &raw.frames {
        let pose = resolver.pose("frames", pose);
        frames.insert(resolver.name("frames", name), pose);
    }
    let camera = resolver.vector("camera_xyz_m", &raw.camera_xyz_m, -FARTHEST_M..=FARTHEST_M);
    Demonstration {
        cloud: resolver.file("cloud", &raw.cloud),
        camera_position: Point3::from(camera),
        frames,
    }
}

fn stages(
    resolver: &mut Resolver,
    raw: &[Spanned<RawStage>],
    demonstration: &Demonstration,
) -> Vec<Stage> {
    match raw.first() {
        None => resolver.fault(Fault::Order, 0..0, "the skill has no [[stage]]"),
        Some(first) if first.get_ref().relative_to.get_ref() != "object" => {
            let at = first.get_ref().relative_to.span();
            let cause = "the first stage must be relative to \"object\": it is what is taken";
            resolver.fault(Fault::Order, at, cause);
        }
        Some(_) => {}
    }
    let mut stages: Vec<Stage> = Vec::with_capacity(raw.len());
    for raw in raw.iter().map(Spanned::get_ref) {
        if stages.iter().any(|stage| stage.name == *raw.name.get_ref()) {
            let cause = format!("a second stage is named {:?}", raw.name.get_ref());
            resolver.fault(Fault::Name, raw.name.span(), cause);
        }
        let read = stage(resolver, raw, demonstration);
        let joined = stages.last().is_some_and(|last| last.lift_m == 0.0 && last.retreat_m == 0.0);
        if let Some(force) = &raw.until_contact_n
            && read.approach_m == 0.0
            && !joined
        {
            let cause = "no straight line leads to this pose on which contact could be felt; \
                         give it an approach_m";
            resolver.fault(Fault::Order, force.span(), cause);
        }
        stages.push(read);
    }
    stages
}

fn stage(resolver: &mut Resolver, raw: &RawStage, demonstration: &Demonstration) -> Stage {
    let line = 0.0..=LONGEST_LINE_M;
    Stage {
        name: resolver.name("name", &raw.name),
        relative_to: relative_to(resolver, &raw.relative_to, demonstration),
        gripper_pose: resolver.pose("gripper_pose", &raw.gripper_pose),
        approach_m: resolver.number_or("approach_m", raw.approach_m.as_ref(), 0.0, line.clone()),
        opening_m: resolver.number_or(
            "opening_m",
            raw.opening_m.as_ref(),
            Stage::OPENING_M,
            0.0..=WIDEST_M,
        ),
        until_contact_n: raw
            .until_contact_n
            .as_ref()
            .map(|force| resolver.number("until_contact_n", force, CONTACT_N)),
        gripper: raw.gripper.as_ref().and_then(|gripper| command(resolver, gripper)),
        retreat_m: resolver.number_or("retreat_m", raw.retreat_m.as_ref(), 0.0, line.clone()),
        lift_m: resolver.number_or("lift_m", raw.lift_m.as_ref(), 0.0, line),
        turn_about_closing_deg: resolver.number_or(
            "turn_about_closing_deg",
            raw.turn_about_closing_deg.as_ref(),
            Stage::TURN_ABOUT_CLOSING_DEG,
            0.0..=180.0,
        ),
        onward: raw.onward,
    }
}

fn relative_to(
    resolver: &mut Resolver,
    raw: &Spanned<String>,
    demonstration: &Demonstration,
) -> RelativeTo {
    if raw.get_ref() == "object" {
        return RelativeTo::Object;
    }
    RelativeTo::Frame(frame_of(resolver, raw, demonstration, ["object"]))
}

/// The name of a frame that the demonstration has; `others` could have been meant, too.
pub(super) fn frame_of<const N: usize>(
    resolver: &mut Resolver,
    raw: &Spanned<String>,
    demonstration: &Demonstration,
    others: [&str; N],
) -> String {
    let name = raw.get_ref();
    if !demonstration.frames.contains_key(name) {
        let known = demonstration.frames.keys().map(String::as_str).chain(others);
        let cause = format!("the demonstration has no frame {name:?}");
        let fault = resolver.source.fault(Fault::Reference, raw.span(), cause);
        resolver.note(fault.suggest(name, known));
    }
    name.clone()
}

fn command(resolver: &mut Resolver, raw: &Spanned<RawGripper>) -> Option<GripperCommand> {
    match (&raw.get_ref().close_n, &raw.get_ref().open_m) {
        (Some(force), None) => Some(GripperCommand::Close {
            force_n: resolver.number("close_n", force, 0.0..=STRONGEST_N),
        }),
        (None, Some(opening)) => Some(GripperCommand::Open {
            opening_m: resolver.number("open_m", opening, 0.0..=WIDEST_M),
        }),
        _ => {
            let cause = "a gripper either closes with close_n or opens to open_m";
            resolver.fault(Fault::Order, raw.span(), cause);
            None
        }
    }
}

/// Plugins by kind: all kinds but those of the cell, each plugin one that there is.
pub(super) fn methods(
    resolver: &mut Resolver,
    raw: &BTreeMap<Spanned<String>, Spanned<String>>,
    known: &KnownMethods,
) -> BTreeMap<Kind, String> {
    // Robot and camera belong to the cell: a skill runs on any that reaches and sees.
    let kinds = Kind::ALL.into_iter().filter(|kind| !matches!(kind, Kind::Robot | Kind::Camera));
    let mut methods = BTreeMap::new();
    for (key, name) in raw {
        let Some(kind) = kinds.clone().find(|kind| kind.name() == key.get_ref()) else {
            let cause = format!("unknown key \"{}\"", key.get_ref());
            let fault = resolver.source.fault(Fault::UnknownKey, key.span(), cause);
            resolver.note(fault.suggest(key.get_ref(), kinds.clone().map(Kind::name)));
            continue;
        };
        if let Some(known) = known.get(&kind)
            && !known.contains(name.get_ref())
        {
            let cause = format!("there is no {kind} plugin {:?}", name.get_ref());
            let fault = resolver.source.fault(Fault::Reference, name.span(), cause);
            resolver.note(fault.suggest(name.get_ref(), known.iter().map(String::as_str)));
        }
        methods.insert(kind, name.get_ref().clone());
    }
    methods
}
