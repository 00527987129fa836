//! What there is, in a form that can be written down.

use super::{Resolution, Set};
use serde::Serialize;

/// A generated cap in a few words.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Entry {
    /// Its name.
    pub name: String,
    /// Its set.
    pub set: &'static str,
    /// Whether it is one of the paper's forty.
    pub paper_40: bool,
    /// Its template.
    pub template: &'static str,
    /// Length of its hem, metres.
    pub circumference_m: f64,
    /// Height of its crown; of a visor, width of its band, metres.
    pub crown_m: f64,
    /// Length of its brim, metres; zero without one.
    pub brim_m: f64,
    /// Its mass, kg.
    pub mass_kg: f64,
    /// Vertices at the standard resolution.
    pub vertices: usize,
}

/// Every generated cap, set by set. Lengths and masses are rounded to 0.1 mm and 0.1 g.
pub fn catalogue() -> Vec<Entry> {
    let forty: Vec<String> = super::names(Set::Paper40);
    let of_set = |set: Set| {
        set.members().into_iter().map(move |(name, member)| {
            let object = member.object(&name, Resolution::default());
            let shape = member.shape();
            let crown = if member.template.pattern().is_open() { shape.band } else { shape.height };
            (name, set.name(), member.template.name(), shape, crown, object)
        })
    };
    Set::DISJOINT
        .into_iter()
        .flat_map(of_set)
        .map(|(name, set, template, shape, crown, object)| Entry {
            paper_40: forty.contains(&name),
            name,
            set,
            template,
            circumference_m: tenths_of_thousandths(shape.circumference),
            crown_m: tenths_of_thousandths(crown),
            brim_m: tenths_of_thousandths(shape.brim_length),
            mass_kg: tenths_of_thousandths(object.mass()),
            vertices: object.mesh().vertices().len(),
        })
        .collect()
}

fn tenths_of_thousandths(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}
