//! The sets of caps and how the shapes of each template are dealt to them.

use super::breadth::Breadth;
use super::hypercube::latin_hypercube;
use super::shape::Shape;
use super::template::Template;

/// A set of caps. [`Set::DISJOINT`] share no shape and no cell of a parameter;
/// [`Set::Paper40`] is a part of [`Set::Train`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Set {
    /// What networks are trained on and demonstrations are given with.
    Train,
    /// Further caps for networks to be trained on, of ranges wider than the category's own.
    Wide,
    /// What choices are made on.
    Validation,
    /// What results are reported on.
    Unseen,
    /// Caps outside the category.
    Beanie,
    /// Forty training caps, as many as the paper had.
    Paper40,
}

/// A cap: its template and its number among the template's shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Member {
    /// Its kind.
    pub template: Template,
    /// Which of the template's hypercubes it is from.
    pub breadth: Breadth,
    /// Its number in that hypercube.
    pub number: usize,
}

/// The caps of [`Set::Wide`], by their place in it, that are left out: they do not sit on a
/// head within 20 degrees, hence have no canonical state to learn.
const UNWEARABLE: [usize; 12] = [13, 54, 63, 69, 72, 113, 114, 143, 180, 225, 238, 256];

impl Set {
    /// Every set.
    pub const ALL: [Self; 6] =
        [Self::Train, Self::Wide, Self::Validation, Self::Unseen, Self::Beanie, Self::Paper40];

    /// The sets that share nothing, in the order in which shapes are dealt to them.
    pub const DISJOINT: [Self; 4] = [Self::Train, Self::Validation, Self::Unseen, Self::Beanie];

    /// The sets that others are no part of: together, every cap there is.
    pub const WHOLE: [Self; 5] =
        [Self::Train, Self::Validation, Self::Unseen, Self::Beanie, Self::Wide];

    /// The set's name, as it stands in the names of its caps.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Train => "train",
            Self::Wide => "wide",
            Self::Validation => "validation",
            Self::Unseen => "unseen",
            Self::Beanie => "beanie",
            Self::Paper40 => "paper-40",
        }
    }

    /// How many caps of each template are dealt to it, in the order of [`Template::ALL`].
    pub const fn quotas(self) -> [usize; 5] {
        match self {
            Self::Train => [60, 9, 10, 11, 0],
            Self::Wide => [180, 27, 30, 33, 0],
            Self::Validation => [6, 1, 1, 2, 0],
            Self::Unseen => [12, 2, 3, 3, 0],
            Self::Beanie => [0, 0, 0, 0, 5],
            Self::Paper40 => [26, 4, 5, 5, 0],
        }
    }

    /// Which ranges its shapes are drawn from.
    pub const fn breadth(self) -> Breadth {
        match self {
            Self::Wide => Breadth::Wide,
            Self::Train | Self::Validation | Self::Unseen | Self::Beanie | Self::Paper40 => {
                Breadth::Usual
            }
        }
    }

    /// Its caps by name, in order. The templates alternate, so that any first part of the set
    /// is mixed like the whole.
    pub fn members(self) -> Vec<(String, Member)> {
        if self == Self::Paper40 {
            return self.chosen_from(Self::Train);
        }
        let quotas = self.quotas();
        let count: usize = quotas.iter().sum();
        let digits = if count > 30 { 3 } else { 2 };
        let mut dealt = [0; 5];
        (0..count)
            .map(|i| {
                let owed = |t: &usize| {
                    quotas[*t] as f64 * (i + 1) as f64 / count as f64 - dealt[*t] as f64
                };
                let next = (0..5).rev().max_by(|a, b| owed(a).total_cmp(&owed(b))).unwrap_or(0);
                let number = self.first_number(next) + dealt[next];
                dealt[next] += 1;
                let name = format!("cap-{}-{i:0digits$}", self.name());
                (name, Member { template: Template::ALL[next], breadth: self.breadth(), number })
            })
            .enumerate()
            .filter(|(i, _)| self != Self::Wide || !UNWEARABLE.contains(i))
            .map(|(_, member)| member)
            .collect()
    }

    /// The first caps of each template in `set`, as many as the quotas say.
    fn chosen_from(self, set: Self) -> Vec<(String, Member)> {
        let mut left = self.quotas();
        let mut members = set.members();
        members.retain(|(_, member)| {
            let wanted = &mut left[member.template as usize];
            let keep = *wanted > 0;
            *wanted -= usize::from(keep);
            keep
        });
        members
    }

    /// How many shapes of the template have gone to the sets before this one.
    fn first_number(self, template: usize) -> usize {
        let before = sharing(self.breadth()).take_while(|set| *set != self);
        before.map(|set| set.quotas()[template]).sum()
    }
}

/// The sets that the shapes of one hypercube are dealt to.
fn sharing(breadth: Breadth) -> impl Iterator<Item = Set> {
    Set::WHOLE.into_iter().filter(move |set| set.breadth() == breadth)
}

impl Template {
    /// How many shapes it has in all sets of this breadth.
    pub fn count(self, breadth: Breadth) -> usize {
        sharing(breadth).map(|set| set.quotas()[self as usize]).sum()
    }

    /// Its shapes, one hypercube for all sets of this breadth together, so that no two sets
    /// share a cell.
    pub fn shapes(self, breadth: Breadth, seed: u64) -> Vec<Shape> {
        let stream = match breadth {
            Breadth::Usual => self.name().to_owned(),
            Breadth::Wide => format!("{} wide", self.name()),
        };
        latin_hypercube(&breadth.of(self.ranges()), self.count(breadth), seed, &stream)
    }
}
