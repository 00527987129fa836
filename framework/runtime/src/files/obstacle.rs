//! What else stands in a scene, e.g. the stand of the camera or a hook on its wall.

use super::codes::Fault;
use super::resolver::Resolver;
use nalgebra::Vector3;
use seeone_core::pose::PoseFields;
use seeone_core::robot::{Shape, Solid};
use serde::Deserialize;
use toml::Spanned;

/// The longest edge of an obstacle, metres.
const LONGEST_M: f64 = 5.0;

/// A box (`size_m`) or a cylinder along z (`radius_m`, `length_m`) about its pose in `world`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawObstacle {
    name: Spanned<String>,
    pose: Spanned<PoseFields>,
    size_m: Option<Spanned<[f64; 3]>>,
    radius_m: Option<Spanned<f64>>,
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
