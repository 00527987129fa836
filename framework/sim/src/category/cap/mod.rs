//! Procedural caps of five templates: a crown, and mostly a brim.
//!
//! Canonical convention: worn on a head, z up, the brim along +y. A bucket hat has no front:
//! its turn about z is arbitrary ([`crate::object::Symmetry::Round`]). It is generated and
//! worn with some turn, which is the one that its canonical state has, and whoever judges a
//! wearing or a prediction takes the turn out, as [`crate::wearing`] does. Beanies are round
//! too, and lie outside the category: no network is trained on them.
//!
//! A name stands for one shape for ever, and for one mesh at a [`Resolution`].

pub mod apart;
mod assemble;
mod breadth;
mod brim;
mod catalogue;
mod crown;
mod hypercube;
mod resolution;
mod sets;
pub mod shape;
mod template;
mod warp;

use crate::object::Object;

pub use breadth::Breadth;
pub use catalogue::{Entry, catalogue};
pub use resolution::Resolution;
pub use sets::{Member, Set};
pub use template::Template;

/// The category's name.
pub const CATEGORY: &str = "cap";

/// Names of a set's caps, in order.
pub fn names(set: Set) -> Vec<String> {
    set.members().into_iter().map(|(name, _)| name).collect()
}

/// The cap of this name, or nothing when there is none.
pub fn named(name: &str) -> Option<Object> {
    named_at(name, Resolution::default())
}

/// The cap of this name meshed at `resolution`, or nothing when there is none.
pub fn named_at(name: &str, resolution: Resolution) -> Option<Object> {
    member(name).map(|member| member.object(name, resolution))
}

/// What kind of cap has this name, or nothing when none has.
pub fn member(name: &str) -> Option<Member> {
    let mut all = Set::WHOLE.into_iter().flat_map(Set::members);
    all.find_map(|(known, member)| (known == name).then_some(member))
}

impl Member {
    /// Its shape.
    pub fn shape(self) -> shape::Shape {
        self.template.shapes(self.breadth, self.template.seed(self.breadth))[self.number]
    }

    /// The cap, under this name.
    pub fn object(self, name: &str, resolution: Resolution) -> Object {
        assemble::assemble(name, self.template, &self.shape(), resolution)
    }
}

/// The caps that `seed` would give a template, at rest; what its own seed was chosen among.
pub fn drawn(
    template: Template,
    breadth: Breadth,
    seed: u64,
    resolution: Resolution,
) -> Vec<Object> {
    let shapes = template.shapes(breadth, seed);
    shapes.iter().map(|shape| assemble::assemble("drawn", template, shape, resolution)).collect()
}
#[cfg(test)]
mod tests;
