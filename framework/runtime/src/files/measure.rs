//! Reading what a skill counts as success.

use super::Demonstration;
use super::codes::Fault;
use super::resolver::Resolver;
use super::skill_file::frame_of;
use super::spanned::Spanned;
use schemars::JsonSchema;
use seeone_plugin::Measure;
use serde::Deserialize;

#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "success")]
pub(super) struct RawSuccess {
    /// What is measured: `worn`, `hung` or `held`.
    measure: Spanned<String>,
    /// Of `worn`: the largest error, as a share of the object's diameter.
    #[schemars(range(min = 1e-3, max = 1.0))]
    tolerance_d: Option<Spanned<f64>>,
    /// Of `held`: the frame at which the object is to be.
    at: Option<Spanned<String>>,
    /// Of `held`: how far from there its centre of mass may be, metres.
    #[schemars(range(min = 1e-3, max = 1.0))]
    within_m: Option<Spanned<f64>>,
}

/// The measure with its own keys and no others.
pub(super) fn measure(
    resolver: &mut Resolver,
    raw: &RawSuccess,
    demonstration: &Demonstration,
) -> Measure {
    match raw.measure.get_ref().as_str() {
        "worn" => {
            only(resolver, raw, &["tolerance_d"]);
            let tolerance_d = raw.tolerance_d.as_ref();
            Measure::Worn { tolerance_d: positive(resolver, raw, "tolerance_d", tolerance_d) }
        }
        "hung" => {
            only(resolver, raw, &[]);
            Measure::Hung
        }
        "held" => {
            only(resolver, raw, &["at", "within_m"]);
            let within_m = raw.within_m.as_ref();
            Measure::Held {
                frame: frame(resolver, raw, demonstration),
                within_m: positive(resolver, raw, "within_m", within_m),
            }
        }
        name => {
            let cause = format!("there is no measure {name:?}");
            let fault = resolver.source.fault(Fault::Reference, raw.measure.span(), cause);
            resolver.note(fault.suggest(name, ["worn", "hung", "held"]));
            Measure::Hung
        }
    }
}

/// Tells of every key that belongs to another measure.
fn only(resolver: &mut Resolver, raw: &RawSuccess, own: &[&str]) {
    let given = [
        ("tolerance_d", raw.tolerance_d.as_ref().map(Spanned::span)),
        ("at", raw.at.as_ref().map(Spanned::span)),
        ("within_m", raw.within_m.as_ref().map(Spanned::span)),
    ];
    for (key, place) in given {
        if let Some(place) = place
            && !own.contains(&key)
        {
            let cause = format!("the measure {:?} has no {key}", raw.measure.get_ref());
            resolver.fault(Fault::UnknownKey, place, cause);
        }
    }
}

/// A number above zero, and at most one diameter or metre, that the measure needs.
fn positive(
    resolver: &mut Resolver,
    raw: &RawSuccess,
    key: &str,
    value: Option<&Spanned<f64>>,
) -> f64 {
    if value.is_none() {
        missing(resolver, raw, key);
    }
    resolver.number_or(key, value, 1.0, 1e-3..=1.0)
}

/// The frame at which the object is to be held.
fn frame(resolver: &mut Resolver, raw: &RawSuccess, demonstration: &Demonstration) -> String {
    match &raw.at {
        Some(at) => frame_of(resolver, at, demonstration, []),
        None => {
            missing(resolver, raw, "at");
            String::new()
        }
    }
}

fn missing(resolver: &mut Resolver, raw: &RawSuccess, key: &str) {
    let cause = format!("the measure {:?} needs {key}", raw.measure.get_ref());
    resolver.fault(Fault::MissingKey, raw.measure.span(), cause);
}
