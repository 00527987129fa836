//! Procedural caps: a crown with a brim in front.
//!
//! Canonical convention: worn on a head, z up, the brim along +y. Every instance has a
//! brim, hence the convention has no rotational ambiguity; hats without one (buckets,
//! beanies) are left out, because their canonical yaw would be arbitrary.

mod assemble;
pub mod brim;
pub mod crown;
mod resolution;
pub mod shape;

use crate::object::Object;
use shape::{Shape, latin_hypercube};

pub use assemble::assemble;
pub use resolution::Resolution;

/// The category's name.
pub const CATEGORY: &str = "cap";

/// The caps' sets, which share no shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Set {
    /// What networks are trained on and demonstrations are given with.
    Train,
    /// What choices are made on.
    Validation,
    /// What results are reported on.
    Unseen,
}

impl Set {
    /// All sets.
    pub const ALL: [Self; 3] = [Self::Train, Self::Validation, Self::Unseen];

    /// The set's name, as it stands in the names of its caps.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Train => "train",
            Self::Validation => "validation",
            Self::Unseen => "unseen",
        }
    }

    /// Number of caps in it and digits of their numbers.
    const fn size(self) -> (usize, usize) {
        match self {
            Self::Train => (100, 3),
            Self::Validation => (4, 2),
            Self::Unseen => (20, 2),
        }
    }

    /// The shapes of the set's caps, each set from a hypercube of its own.
    pub fn shapes(self) -> Vec<Shape> {
        latin_hypercube(self.size().0, SEED, self.name())
    }

    fn name_of(self, number: usize) -> String {
        format!("cap-{}-{number:0digits$}", self.name(), digits = self.size().1)
    }
}

/// Seed of every set: a name stands for one shape for ever.
const SEED: u64 = 20;

/// Names of a set's caps, in order.
pub fn names(set: Set) -> Vec<String> {
    (0..set.size().0).map(|i| set.name_of(i)).collect()
}

/// The cap of this name, or nothing when there is none.
pub fn named(name: &str) -> Option<Object> {
    named_at(name, Resolution::default())
}

/// The cap of this name meshed at `resolution`, or nothing when there is none.
pub fn named_at(name: &str, resolution: Resolution) -> Option<Object> {
    Set::ALL.into_iter().find_map(|set| {
        let number = (0..set.size().0).find(|i| set.name_of(*i) == name)?;
        Some(assemble(name, &set.shapes()[number], resolution))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::object::Region;
    use nalgebra::Point3;

    /// Points at the same places of the pattern on every cap, in units of its length.
    fn pattern(shape: &Shape) -> Vec<Point3<f64>> {
        let crown = crown::vertices(shape, Resolution::default());
        let rows = Resolution::default().brim_rows();
        let brim = brim::build(shape, Resolution::default(), &crown).vertices;
        let columns = brim.len() / rows;
        let at = |part: f64| ((columns - 1) as f64 * part).round() as usize * rows;
        let samples = (0..=8).flat_map(|c| {
            let first = at(f64::from(c) / 8.0);
            brim[first..first + rows].to_vec()
        });
        let all: Vec<Point3<f64>> = crown.iter().copied().chain(samples).collect();
        let length = all.iter().map(|p| p.y).fold(0.0, f64::max) * 2.0;
        all.into_iter().map(|p| p / length).collect()
    }

    #[test]
    fn no_unseen_cap_is_nearly_a_training_cap() {
        let known: Vec<_> = Set::Train.shapes().iter().map(pattern).collect();
        let mut nearest = f64::INFINITY;
        for unseen in Set::Unseen.shapes().iter().map(pattern) {
            for other in &known {
                let apart: f64 = unseen.iter().zip(other).map(|(a, b)| (a - b).norm()).sum();
                nearest = nearest.min(apart / unseen.len() as f64);
            }
        }
        assert!(nearest > NEAR_DUPLICATE, "two caps are only {nearest} apart");
    }

    /// Mean distance of corresponding vertices below which two caps are the same.
    const NEAR_DUPLICATE: f64 = 0.01;

    #[test]
    fn every_cap_has_its_parts_and_a_plausible_size() {
        for set in Set::ALL {
            for name in names(set) {
                let object = named(&name).expect("a cap of this name");
                let count = object.mesh().vertices().len();
                assert!((440..=580).contains(&count), "{name} has {count} vertices");
                assert!((0.025..0.080).contains(&object.mass()), "{name}: {}", object.mass());
                for region in [Region::Crown, Region::Brim, Region::Hem] {
                    assert!(!object.vertices_of(region).is_empty(), "{name} lacks {region:?}");
                }
                let (low, high) = object.mesh().bounds();
                assert!(high.y > -low.y + 0.03, "{name}: the brim points along +y");
            }
        }
        assert!(named("cap-train-100").is_none() && named("hat").is_none());
    }

    #[test]
    fn a_finer_cap_is_the_same_cap() {
        let count = |o: &Object| o.mesh().vertices().len();
        let coarse = named_at("cap-unseen-03", Resolution::COARSE).expect("a cap");
        let fine = named_at("cap-unseen-03", Resolution::FINE).expect("a cap");
        let finest = named_at("cap-unseen-03", Resolution::FINEST).expect("a cap");
        assert!((230..310).contains(&count(&coarse)), "{}", count(&coarse));
        assert!((900..1150).contains(&count(&fine)), "{}", count(&fine));
        assert!((1800..2300).contains(&count(&finest)), "{}", count(&finest));
        let (mass, size) = (fine.mass(), fine.mesh().diameter());
        for other in [&coarse, &finest, &named("cap-unseen-03").expect("a cap")] {
            assert!((other.mass() / mass - 1.0).abs() < 0.08, "{} against {mass}", other.mass());
            assert!((other.mesh().diameter() / size - 1.0).abs() < 0.03);
        }
    }

    /// The longest edges are those of the fans that close the brim's ends.
    #[test]
    fn edges_are_neither_slivers_nor_gaps() {
        for name in names(Set::Unseen) {
            let object = named(&name).expect("a cap of this name");
            let vertices = object.mesh().vertices();
            for t in object.mesh().triangles() {
                for i in 0..3 {
                    let [a, b] = [t[i], t[(i + 1) % 3]].map(|v| vertices[v as usize]);
                    let length = (a - b).norm();
                    assert!((0.003..0.075).contains(&length), "{name}: an edge of {length} m");
                }
            }
        }
    }
}
