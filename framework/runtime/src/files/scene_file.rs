//! Reading a scene.

use super::beside::{RawBeside, beside};
use super::codes::{Family, Fault};
use super::exactly::Exactly;
use super::hook::{RawHook, further_hooks, hook};
use super::obstacle::{RawObstacle, obstacle};
use super::pose::{RawIntrinsics, RawPose};
use super::resolver::Resolver;
use super::source::Source;
use super::spanned::Spanned;
use super::{Drop, Head, Hook, KnownMethods, Scene, Table, Targets};
use nalgebra::{Point2, Vector2};
use schemars::JsonSchema;
use seeone_core::head::SEMI_AXIS_M;
use seeone_core::{Diagnostic, HeadSize, Intrinsics, Peg, Pose};
use seeone_plugin::Kind;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::path::Path;

/// A scene file: what stands where, and which object lies on the table.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "scene")]
pub(super) struct RawScene {
    /// The version of the format.
    #[serde(rename = "schema")]
    #[schemars(extend("const" = 1))]
    _schema: u32,
    /// Its name: small letters, digits and hyphens.
    name: Spanned<String>,
    /// The object that lies there: its name, or the name of a set to draw from.
    object: Spanned<String>,
    /// Further objects that lie there; the scene then has no head.
    #[serde(default)]
    beside: Vec<Spanned<RawBeside>>,
    /// The table.
    table: RawTable,
    /// The head: z up, +y where the face looks. A scene has a head, a hook or both.
    head: Option<RawHead>,
    /// The hook: a peg on a wall; z up, +y out of the wall.
    hook: Option<RawHook>,
    /// Further places by name, that skills may refer to.
    #[serde(default)]
    frames: BTreeMap<Spanned<String>, Spanned<RawPose>>,
    /// The depth camera.
    camera: RawCamera,
    /// Where objects are dropped and looked for.
    drop: RawDrop,
    /// What else the arm must not touch.
    #[serde(default)]
    obstacle: Vec<RawObstacle>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "table")]
struct RawTable {
    /// Top of the mat, metres; 0 when it is not said.
    #[schemars(range(min = -FARTHEST_M, max = FARTHEST_M))]
    height_m: Option<Spanned<f64>>,
    /// How far the robot may sink into the mat, metres; 0.03 when it is not said.
    #[schemars(range(min = 0.0, max = 0.2))]
    soft_m: Option<Spanned<f64>>,
    /// Coulomb friction of the mat.
    #[schemars(range(min = 0.0, max = 2.0))]
    friction: Spanned<f64>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "head")]
struct RawHead {
    /// Its frame.
    pose: Spanned<RawPose>,
    /// How large it is: `small`, `medium` or `large`; or else `semi_axes_m`.
    size: Option<Spanned<String>>,
    /// Semi-axes of its ellipsoid, metres.
    semi_axes_m: Option<Spanned<Exactly<f64, 3>>>,
    /// Coulomb friction of its surface.
    #[schemars(range(min = 0.0, max = 2.0))]
    friction: Spanned<f64>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "camera")]
struct RawCamera {
    /// The camera plugin; the first there is when it is not said.
    plugin: Option<Spanned<String>>,
    /// A recorded PLY cloud below the scene's folder, for a plugin that shows one.
    cloud: Option<Spanned<String>>,
    /// Whether the object is told by its colour, wherever it is in the picture; `false` when it is
    /// not said, and it is then what lies in the box of `[drop]`.
    #[serde(default)]
    by_colour: bool,
    /// Its frame: x right, y down, z forward.
    pose: Spanned<RawPose>,
    /// Its intrinsics.
    intrinsics: Spanned<RawIntrinsics>,
}

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "drop")]
struct RawDrop {
    /// Middle of the zone, metres.
    centre_xy_m: Spanned<Exactly<f64, 2>>,
    /// Half the sides of the box in which the object is looked for, metres.
    half_extents_m: Spanned<Exactly<f64, 2>>,
    /// Height of that box above the table, metres.
    #[schemars(range(min = 0.01, max = FARTHEST_M))]
    crop_height_m: Spanned<f64>,
    /// Several objects may lie in the box, each farther from the others than this, metres; the
    /// camera then shows one of them. Left out, whatever lies there is one object.
    #[schemars(range(min = APART_M[0], max = APART_M[1]))]
    apart_m: Option<Spanned<f64>>,
}

/// How far the robot may sink into the mat when the file does not say it, metres.
const SOFT_M: f64 = 0.03;
/// How far apart objects can be told to lie, metres.
const APART_M: [f64; 2] = [0.01, 1.0];
/// The farthest coordinate of a table or a drop zone, metres.
const FARTHEST_M: f64 = 5.0;
/// The focal lengths of a camera, pixels.
const FOCAL_PIXELS: RangeInclusive<f64> = 1.0..=1e5;
/// The most pixels of an image.
const MOST_PIXELS: usize = 4 << 20;

impl Scene {
    /// Reads and checks a scene.
    ///
    /// # Errors
    /// Every fault found, codes `C0xx`.
    pub fn read(path: &Path, known: &KnownMethods) -> Result<Self, Vec<Diagnostic>> {
        let source = Source::open(Family::Scene, path).map_err(|fault| vec![fault])?;
        let raw: RawScene = source.parse()?;
        let mut resolver = Resolver::new(&source);
        let height = raw.table.height_m.as_ref();
        let table = Table {
            height_m: resolver.number_or("height_m", height, 0.0, -FARTHEST_M..=FARTHEST_M),
            soft_m: resolver.number_or("soft_m", raw.table.soft_m.as_ref(), SOFT_M, 0.0..=0.2),
            friction: resolver.number("friction", &raw.table.friction, 0.0..=2.0),
        };
        let drop = drop_zone(&mut resolver, &raw.drop);
        let head = raw.head.as_ref().map(|raw| head(&mut resolver, raw));
        let further = raw
            .hook
            .as_ref()
            .map(|raw| further_hooks(&mut resolver, raw, &drop, table.height_m))
            .unwrap_or_default();
        let hook = raw.hook.as_ref().map(|raw| hook(&mut resolver, raw, &drop, table.height_m));
        let beside = beside(&mut resolver, &raw.beside, &drop, head.is_some());
        let targets = targets(&mut resolver, head, hook);
        let scene = Scene {
            name: resolver.name("name", &raw.name),
            object: resolver.name("object", &raw.object),
            table,
            beside,
            targets,
            places: places(&mut resolver, &raw.frames, &further),
            further_hooks: further,
            camera_plugin: camera_plugin(&mut resolver, raw.camera.plugin.as_ref(), known),
            camera_cloud: raw.camera.cloud.as_ref().map(|cloud| {
                let path = resolver.file("cloud", cloud);
                // A plugin resolves paths against another folder than this file's.
                path.canonicalize().unwrap_or(path)
            }),
            camera_by_colour: raw.camera.by_colour,
            camera: resolver.pose("pose", &raw.camera.pose),
            intrinsics: intrinsics(&mut resolver, &raw.camera.intrinsics),
            drop,
            standing: raw.obstacle.iter().map(|raw| obstacle(&mut resolver, raw)).collect(),
        };
        resolver.finish(scene)
    }
}

fn targets(resolver: &mut Resolver, head: Option<Head>, hook: Option<Hook>) -> Targets {
    match (head, hook) {
        (Some(head), None) => Targets::Head(head),
        (None, Some(hook)) => Targets::Hook(hook),
        (Some(head), Some(hook)) => Targets::Both(head, hook),
        (None, None) => {
            let cause = "the scene has neither a [head] nor a [hook]";
            resolver.fault(Fault::MissingKey, 0..0, cause);
            Targets::Hook(Hook { pose: Pose::identity(), peg: Peg::COAT, friction: 0.0 })
        }
    }
}

fn places(
    resolver: &mut Resolver,
    raw: &BTreeMap<Spanned<String>, Spanned<RawPose>>,
    further_hooks: &BTreeMap<String, Pose>,
) -> BTreeMap<String, Pose> {
    let mut places = BTreeMap::new();
    for (name, pose) in raw {
        if further_hooks.contains_key(name.get_ref()) {
            let cause = format!("{:?} is the name of a further hook already", name.get_ref());
            resolver.fault(Fault::Name, name.span(), cause);
        }
        places.insert(resolver.place_name("frames", name), resolver.pose("frames", pose));
    }
    places
}

fn head(resolver: &mut Resolver, raw: &RawHead) -> Head {
    Head {
        pose: resolver.pose("pose", &raw.pose),
        size: head_size(resolver, raw),
        friction: resolver.number("friction", &raw.friction, 0.0..=2.0),
    }
}

/// The head's size: either its name or its semi-axes.
fn head_size(resolver: &mut Resolver, raw: &RawHead) -> HeadSize {
    let size = match (&raw.size, &raw.semi_axes_m) {
        (Some(name), None) => named_size(resolver, name),
        (None, Some(axes)) => {
            let [low, high] = SEMI_AXIS_M;
            HeadSize::of_semi_axes(resolver.numbers("semi_axes_m", axes, low..=high))
        }
        (Some(_), Some(axes)) => {
            let cause = "the head has a size already";
            resolver.fault(Fault::Order, axes.span(), cause);
            None
        }
        (None, None) => {
            let cause = "the head has neither a size nor semi_axes_m";
            resolver.fault(Fault::MissingKey, raw.pose.span(), cause);
            None
        }
    };
    size.unwrap_or(HeadSize::MEDIUM)
}

fn named_size(resolver: &mut Resolver, name: &Spanned<String>) -> Option<HeadSize> {
    let size = HeadSize::named(name.get_ref());
    if size.is_none() {
        let cause = format!("there is no head of the size {:?}", name.get_ref());
        let fault = resolver.source.fault(Fault::Reference, name.span(), cause);
        let names = HeadSize::NAMED.into_iter().map(|(name, _)| name);
        resolver.note(fault.suggest(name.get_ref(), names));
    }
    size
}

fn camera_plugin(
    resolver: &mut Resolver,
    raw: Option<&Spanned<String>>,
    known: &KnownMethods,
) -> Option<String> {
    let raw = raw?;
    let name = raw.get_ref();
    if let Some(known) = known.get(&Kind::Camera)
        && !known.contains(name)
    {
        let cause = format!("there is no camera plugin {name:?}");
        let fault = resolver.source.fault(Fault::Reference, raw.span(), cause);
        resolver.note(fault.suggest(name, known.iter().map(String::as_str)));
    }
    Some(name.clone())
}

fn intrinsics(resolver: &mut Resolver, raw: &Spanned<RawIntrinsics>) -> Intrinsics {
    let lens = Intrinsics::from(*raw.get_ref());
    let pixels = lens.width.saturating_mul(lens.height);
    if pixels == 0 || pixels > MOST_PIXELS {
        let cause = format!("an image of {} x {} pixels", lens.width, lens.height);
        resolver.fault(Fault::Range, raw.span(), cause);
    }
    if ![lens.fx, lens.fy].iter().all(|f| FOCAL_PIXELS.contains(f)) {
        let (low, high) = FOCAL_PIXELS.into_inner();
        let cause = format!("the focal lengths fx and fy must lie in {low} to {high}");
        resolver.fault(Fault::Range, raw.span(), cause);
    }
    if ![lens.cx, lens.cy].iter().all(|c| c.abs() <= *FOCAL_PIXELS.end()) {
        resolver.fault(
            Fault::Range,
            raw.span(),
            "the principal point cx, cy lies far off the image",
        );
    }
    lens
}

fn drop_zone(resolver: &mut Resolver, raw: &RawDrop) -> Drop {
    let centre = resolver.numbers("centre_xy_m", &raw.centre_xy_m, -FARTHEST_M..=FARTHEST_M);
    let half = resolver.numbers("half_extents_m", &raw.half_extents_m, 0.01..=FARTHEST_M);
    let [low, high] = APART_M;
    let apart_m = raw.apart_m.as_ref();
    let apart_m = apart_m.map(|apart| resolver.number("apart_m", apart, low..=high));
    Drop {
        centre: Point2::from(centre),
        half_extents_m: Vector2::from(half),
        crop_height_m: resolver.number("crop_height_m", &raw.crop_height_m, 0.01..=FARTHEST_M),
        apart_m,
    }
}
