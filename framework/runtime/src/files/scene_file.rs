//! Reading a scene.

use super::codes::{Family, Fault};
use super::hook::{RawHook, hook};
use super::obstacle::{RawObstacle, obstacle};
use super::resolver::Resolver;
use super::source::Source;
use super::{Drop, Head, Hook, KnownMethods, Scene, Table, Targets};
use nalgebra::{Point2, Vector2};
use seeone_core::head::SEMI_AXIS_M;
use seeone_core::pose::PoseFields;
use seeone_core::{Diagnostic, HeadSize, Intrinsics, Peg, Pose};
use seeone_plugin::Kind;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawScene {
    #[serde(rename = "schema")]
    _schema: u32,
    name: Spanned<String>,
    object: Spanned<String>,
    table: RawTable,
    head: Option<RawHead>,
    hook: Option<RawHook>,
    #[serde(default)]
    frames: BTreeMap<Spanned<String>, Spanned<PoseFields>>,
    camera: RawCamera,
    drop: RawDrop,
    #[serde(default)]
    obstacle: Vec<RawObstacle>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawTable {
    height_m: Option<Spanned<f64>>,
    soft_m: Option<Spanned<f64>>,
    friction: Spanned<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawHead {
    pose: Spanned<PoseFields>,
    size: Option<Spanned<String>>,
    semi_axes_m: Option<Spanned<[f64; 3]>>,
    friction: Spanned<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawCamera {
    plugin: Option<Spanned<String>>,
    cloud: Option<Spanned<String>>,
    pose: Spanned<PoseFields>,
    intrinsics: Spanned<Intrinsics>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawDrop {
    centre_xy_m: Spanned<[f64; 2]>,
    half_extents_m: Spanned<[f64; 2]>,
    crop_height_m: Spanned<f64>,
}

/// How far the robot may sink into the mat when the file does not say it, metres.
const SOFT_M: f64 = 0.03;
/// The farthest coordinate of a table or a drop zone, metres.
const FARTHEST_M: f64 = 5.0;
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
        let hook = raw.hook.as_ref().map(|raw| hook(&mut resolver, raw, &drop, table.height_m));
        let targets = targets(&mut resolver, head, hook);
        let scene = Scene {
            name: resolver.name("name", &raw.name),
            object: resolver.name("object", &raw.object),
            table,
            targets,
            places: places(&mut resolver, &raw.frames),
            camera_plugin: camera_plugin(&mut resolver, raw.camera.plugin.as_ref(), known),
            camera_cloud: raw.camera.cloud.as_ref().map(|cloud| {
                let path = resolver.file("cloud", cloud);
                // A plugin resolves paths against another folder than this file's.
                path.canonicalize().unwrap_or(path)
            }),
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
    raw: &BTreeMap<Spanned<String>, Spanned<PoseFields>>,
) -> BTreeMap<String, Pose> {
    let mut places = BTreeMap::new();
    for (name, pose) in raw {
        if ["object", "head", "hook"].contains(&name.get_ref().as_str()) {
            let cause = format!("{:?} is no name for a place: it means another", name.get_ref());
            resolver.fault(Fault::Name, name.span(), cause);
        }
        places.insert(resolver.name("frames", name), resolver.pose("frames", pose));
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

fn intrinsics(resolver: &mut Resolver, raw: &Spanned<Intrinsics>) -> Intrinsics {
    let lens = *raw.get_ref();
    let pixels = lens.width.saturating_mul(lens.height);
    if pixels == 0 || pixels > MOST_PIXELS {
        let cause = format!("an image of {} x {} pixels", lens.width, lens.height);
        resolver.fault(Fault::Range, raw.span(), cause);
    }
    if lens.fx <= 0.0 || lens.fy <= 0.0 {
        resolver.fault(Fault::Range, raw.span(), "the focal lengths fx and fy must be positive");
    }
    lens
}

fn drop_zone(resolver: &mut Resolver, raw: &RawDrop) -> Drop {
    let centre = resolver.numbers("centre_xy_m", &raw.centre_xy_m, -FARTHEST_M..=FARTHEST_M);
    let half = resolver.numbers("half_extents_m", &raw.half_extents_m, 0.01..=FARTHEST_M);
    Drop {
        centre: Point2::from(centre),
        half_extents_m: Vector2::from(half),
        crop_height_m: resolver.number("crop_height_m", &raw.crop_height_m, 0.01..=FARTHEST_M),
    }
}
