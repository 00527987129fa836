//! Reading what a robot looks for itself when it is done.

use super::resolver::Resolver;
use super::skill_file::frame_of;
use super::spanned::Spanned;
use super::{Demonstration, ShownResult};
use schemars::JsonSchema;
use serde::Deserialize;
use std::ops::RangeInclusive;

/// How the object lay when the demonstration was over. A robot that is done looks whether its
/// object lies so as well, and tries again where it does not.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "result")]
pub(super) struct RawResult {
    /// A PLY file below the skill's folder: the object's points in `world`, metres, after the
    /// last stage, seen from where the demonstration was seen.
    cloud: Spanned<String>,
    /// The frame of the demonstration in which it lies.
    relative_to: Spanned<String>,
    /// How far from there the object may be, metres.
    #[schemars(range(min = *WITHIN_M.start(), max = *WITHIN_M.end()))]
    within_m: Spanned<f64>,
    /// By how much its up axis may be turned against how it was, degrees.
    #[schemars(range(min = *WITHIN_DEG.start(), max = *WITHIN_DEG.end()))]
    within_deg: Spanned<f64>,
}

/// The distances that may be allowed, metres.
const WITHIN_M: RangeInclusive<f64> = 1e-3..=1.0;
/// The turns that may be allowed, degrees.
const WITHIN_DEG: RangeInclusive<f64> = 1.0..=180.0;

pub(super) fn shown_result(
    resolver: &mut Resolver,
    raw: &RawResult,
    demonstration: &Demonstration,
) -> ShownResult {
    ShownResult {
        cloud: resolver.file("cloud", &raw.cloud),
        frame: frame_of(resolver, &raw.relative_to, demonstration, []),
        within_m: resolver.number("within_m", &raw.within_m, WITHIN_M),
        within_deg: resolver.number("within_deg", &raw.within_deg, WITHIN_DEG),
    }
}
