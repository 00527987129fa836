//! Reading the further objects of a scene.

use super::codes::Fault;
use super::exactly::Exactly;
use super::resolver::Resolver;
use super::spanned::Spanned;
use super::{Beside, Drop};
use nalgebra::Point2;
use schemars::JsonSchema;
use serde::Deserialize;

/// The most further objects.
const MOST: usize = 8;
/// The farthest coordinate of a place in the drop zone, metres.
const FARTHEST_M: f64 = 5.0;

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "beside")]
pub(super) struct RawBeside {
    /// The object: its name, or the name of a set to draw from.
    object: Spanned<String>,
    /// Over which place of the drop zone it is dropped, metres.
    centre_xy_m: Spanned<Exactly<f64, 2>>,
}

/// The further objects, within the zone and where the camera tells objects apart. Worn is one
/// object alone, so a scene with a head has none.
pub(super) fn beside(
    resolver: &mut Resolver,
    raw: &[Spanned<RawBeside>],
    drop: &Drop,
    with_head: bool,
) -> Vec<Beside> {
    if let Some(first) = raw.first() {
        if raw.len() > MOST {
            let cause = format!("a scene has at most {MOST} objects beside the first");
            resolver.fault(Fault::Order, first.span(), cause);
        }
        if with_head {
            let cause = "a scene with a head has one object, but there is one beside it";
            resolver.fault(Fault::Order, first.span(), cause);
        }
        if drop.apart_m.is_none() {
            let cause = "objects beside each other, but [drop] has no apart_m to tell them apart";
            resolver.fault(Fault::MissingKey, first.span(), cause);
        }
    }
    raw.iter().map(|raw| one(resolver, raw.get_ref(), drop)).collect()
}

fn one(resolver: &mut Resolver, raw: &RawBeside, drop: &Drop) -> Beside {
    let at = resolver.numbers("centre_xy_m", &raw.centre_xy_m, -FARTHEST_M..=FARTHEST_M);
    let centre = Point2::from(at);
    let off = (centre - drop.centre).abs();
    if off.x > drop.half_extents_m.x || off.y > drop.half_extents_m.y {
        let cause = "the object is dropped outside the box in which objects are looked for";
        resolver.fault(Fault::Range, raw.centre_xy_m.span(), cause);
    }
    Beside { object: resolver.name("object", &raw.object), centre }
}
