//! Reading the hook of a scene.

use super::codes::Fault;
use super::pose::RawPose;
use super::resolver::Resolver;
use super::spanned::Spanned;
use super::{Drop, Hook};
use nalgebra::{Point3, Vector3};
use schemars::JsonSchema;
use seeone_core::hook::PEG_LENGTH_M;
use seeone_core::{Peg, Pose};
use serde::Deserialize;
use std::collections::BTreeMap;

/// The wall stands upright to within this, radians.
const UPRIGHT_RAD: f64 = 0.01;

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "hook")]
pub(super) struct RawHook {
    /// Its frame, in the wall.
    pose: Spanned<RawPose>,
    /// How far the peg stands out of the wall, metres; a coat peg's when it is not said.
    #[schemars(range(min = PEG_LENGTH_M[0], max = PEG_LENGTH_M[1]))]
    length_m: Option<Spanned<f64>>,
    /// Coulomb friction of the peg.
    #[schemars(range(min = 0.0, max = 2.0))]
    friction: Spanned<f64>,
    /// The frames of further hooks like this one, by name.
    #[serde(default)]
    further: BTreeMap<Spanned<String>, Spanned<RawPose>>,
}

/// The further hooks, whose walls stand upright behind the drop zone.
pub(super) fn further_hooks(
    resolver: &mut Resolver,
    raw: &RawHook,
    drop: &Drop,
    height_m: f64,
) -> BTreeMap<String, Pose> {
    let named = raw.further.iter().map(|(name, pose)| {
        let name = resolver.place_name("further", name);
        (name, upright(resolver, pose, drop, height_m))
    });
    named.collect()
}

fn upright(resolver: &mut Resolver, raw: &Spanned<RawPose>, drop: &Drop, height_m: f64) -> Pose {
    let pose = resolver.pose("pose", raw);
    if (pose.rotation * Vector3::z()).angle(&Vector3::z()) > UPRIGHT_RAD {
        let cause = "the wall of the hook leans: the z axis of its frame must point up";
        resolver.fault(Fault::Pose, raw.span(), cause);
    } else if !before_the_wall(&pose, drop, height_m) {
        let cause = "the wall of the hook stands in the drop zone: y of its frame must point out \
                     of the wall, to the whole zone";
        resolver.fault(Fault::Order, raw.span(), cause);
    }
    pose
}

/// The hook, whose wall stands upright behind the drop zone.
pub(super) fn hook(resolver: &mut Resolver, raw: &RawHook, drop: &Drop, height_m: f64) -> Hook {
    let pose = upright(resolver, &raw.pose, drop, height_m);
    let [low, high] = PEG_LENGTH_M;
    let length_m = raw.length_m.as_ref();
    let length_m = resolver.number_or("length_m", length_m, Peg::COAT.length_m(), low..=high);
    Hook {
        pose,
        peg: Peg::of_length(length_m).unwrap_or(Peg::COAT),
        friction: resolver.number("friction", &raw.friction, 0.0..=2.0),
    }
}

/// Whether every corner of the zone lies on the side of the wall to which the peg points.
fn before_the_wall(hook: &Pose, drop: &Drop, height_m: f64) -> bool {
    [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)].iter().all(|(x, y)| {
        let [half_x, half_y] = drop.half_extents_m.into();
        let corner = Point3::new(drop.centre.x + x * half_x, drop.centre.y + y * half_y, height_m);
        hook.inverse_transform_point(&corner).y > 0.0
    })
}
