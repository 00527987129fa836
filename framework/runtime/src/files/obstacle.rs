//! What else stands in a scene, e.g. the stand of the camera or a hook on its wall.

use super::codes::Fault;
use super::exactly::Exactly;
use super::pose::RawPose;
use super::resolver::Resolver;
use super::spanned::Spanned;
use nalgebra::Vector3;
use schemars::JsonSchema;
use seeone_core::robot::{Shape, Solid};
use serde::Deserialize;

/// The longest edge of an obstacle, metres.
const LONGEST_M: f64 = 5.0;

/// A box (`size_m`) or a cylinder along z (`radius_m`, `length_m`) about its pose in `world`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "obstacle")]
pub(super) struct RawObstacle {
    /// Its name in reasons.
    name: Spanned<String>,
    /// Its middle.
    pose: Spanned<RawPose>,
    /// Edges of a box, metres.
    size_m: Option<Spanned<Exactly<f64, 3>>>,
    /// Radius of a cylinder, metres.
    #[schemars(range(min = 1e-3, max = LONGEST_M))]
    radius_m: Option<Spanned<f64>>,
    /// Length of a cylinder, metres.
    #[schemars(range(min = 1e-3, max = LONGEST_M))]
    length_m: Option<Spanned<f64>>,
}

/// The obstacle as a body in `world`.
pub(super) fn obstacle(resolver: &mut Resolver, raw: &RawObstacle) -> Solid {
    let lengths = 1e-3..=LONGEST_M;
    let shape = match (&raw.size_m, &raw.radius_m, &raw.length_m) {
        (Some(size), None, None) => {
            let size = resolver.numbers("size_m", size, lengths);
            Shape::Box { half_m: Vector3::from(size) * 0.5 }
        }
        (None, Some(radius), Some(length)) => Shape::Cylinder {
            radius_m: resolver.number("radius_m", radius, lengths.clone()),
            length_m: resolver.number("length_m", length, lengths),
        },
        _ => {
            let cause = "an obstacle has either size_m, or radius_m and length_m";
            resolver.fault(Fault::MissingKey, raw.name.span(), cause);
            Shape::Sphere { radius_m: 1.0 }
        }
    };
    Solid { part: resolver.name("name", &raw.name), shape, pose: resolver.pose("pose", &raw.pose) }
}
