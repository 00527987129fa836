//! The sets of caps and how the shapes of each template are dealt to them.

use super::hypercube::latin_hypercube;
use super::shape::Shape;
use super::template::Template;

/// A set of caps. All but [`Set::Paper40`], which is a part of [`Set::Train`], share no
/// shape and no cell of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Set {
    /// What networks are trained on and demonstrations are given with.
    Train,
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
    /// Its number in the template's hypercube.
    pub number: usize,
}

impl Set {
    /// Every set.
    pub const ALL: [Self; 5] =
        [Self::Train, Self::Validation, Self::Unseen, Self::Beanie, Self::Paper40];

    /// The sets that share nothing, in the order in which shapes are dealt to them.
    pub const DISJOINT: [Self; 4] = [Self::Train, Self::Validation, Self::Unseen, Self::Beanie];

    /// The set's name, as it stands in the names of its caps.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Train => "train",
            Self::Validation => "validation",
            Self::Unseen => "unseen",
            Self::Beanie => "beanie",
            Self::Paper40 => "paper-40",
        }
    }

    /// How many caps of each template it has, in the order of [`Template::ALL`].
    pub const fn quotas(self) -> [usize; 5] {
        match self {
            Self::Train => [60, 9, 10, 11, 0],
            Self::Validation => [6, 1, 1, 2, 0],
            Self::Unseen => [12, 2, 3, 3, 0],
            Self::Beanie => [0, 0, 0, 0, 5],
            Self::Paper40 => [26, 4, 5, 5, 0],
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
                (name, Member { template: Template::ALL[next], number })
            })
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
        let before = Self::DISJOINT.into_iter().take_while(|set| *set != self);
        before.map(|set| set.quotas()[template]).sum()
    }
}

impl Template {
    /// How many shapes it has in all sets.
    pub fn count(self) -> usize {
        Set::DISJOINT.into_iter().map(|set| set.quotas()[self as usize]).sum()
    }

    /// Its shapes, one hypercube for all sets together, so that no two sets share a cell.
    pub fn shapes(self, seed: u64) -> Vec<Shape> {
        latin_hypercube(self.ranges(), self.count(), seed, self.name())
    }
}
