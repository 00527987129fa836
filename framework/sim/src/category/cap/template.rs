//! The templates: kinds of caps, each with one topology and its own ranges.

mod baseball;
mod beanie;
mod bucket;
mod flat;
mod visor;

use super::breadth::Breadth;
use super::resolution::Resolution;
use super::shape::{Range, Shape};
use crate::object::Symmetry;

/// A kind of cap. All instances of one have the same triangles at a resolution, so that the
/// index of a vertex is its correspondence.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Template {
    /// Six panels, a stiff visor and a strap hole.
    Baseball,
    /// A soft brim all round.
    Bucket,
    /// A sun visor: a band with a visor, open at the top.
    Visor,
    /// A flat cap: a low crown that leans over a short visor.
    Flat,
    /// A knitted cap without a brim; outside the category.
    Beanie,
}

/// Where a template's mesh has what. Numbers are parts, so that they hold at any resolution.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pattern {
    /// Part of the disc's rings, from the apex, that the crown lacks: zero for a closed one.
    pub open: f64,
    /// The brim.
    pub brim: BrimPattern,
    /// The strap hole, if any.
    pub strap_hole: Option<StrapHole>,
}

/// Where a brim hangs on the hem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BrimPattern {
    /// Nowhere.
    None,
    /// In front, to both sides of the middle.
    Front {
        /// Part of the hem from its middle to the brim's end.
        reach: f64,
        /// Part of the resolution's rows.
        rows: f64,
    },
    /// All round.
    Round {
        /// Part of the resolution's rows.
        rows: f64,
    },
}

/// The half ellipse of missing triangles above the band at the back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrapHole {
    /// Half of its angle in the disc, radians.
    pub half_angle: f64,
    /// Its height as a part of the way from hem to apex.
    pub height: f64,
}

impl Template {
    /// Every template, the one outside the category last.
    pub const ALL: [Self; 5] =
        [Self::Baseball, Self::Bucket, Self::Visor, Self::Flat, Self::Beanie];

    /// Its name.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Baseball => "baseball",
            Self::Bucket => "bucket",
            Self::Visor => "visor",
            Self::Flat => "flat",
            Self::Beanie => "beanie",
        }
    }

    /// The ranges of its parameters.
    pub const fn ranges(self) -> &'static Shape<Range> {
        match self {
            Self::Baseball => &baseball::RANGES,
            Self::Bucket => &bucket::RANGES,
            Self::Visor => &visor::RANGES,
            Self::Flat => &flat::RANGES,
            Self::Beanie => &beanie::RANGES,
        }
    }

    /// Seed of its shapes: a name stands for one shape for ever. Its usual caps are all further
    /// apart than [`super::apart::NEAR_DUPLICATE`], and its wide ones that far from all usual
    /// ones; the example `apart` searches such seeds.
    pub const fn seed(self, breadth: Breadth) -> u64 {
        match (breadth, self) {
            (Breadth::Usual, Self::Baseball) => 45,
            (Breadth::Usual, Self::Bucket) => 38,
            (Breadth::Usual, Self::Visor) => 3,
            (Breadth::Usual, Self::Flat) => 14,
            (Breadth::Usual, Self::Beanie) => 0,
            (Breadth::Wide, Self::Bucket) => 1,
            (Breadth::Wide, Self::Flat) => 2,
            (Breadth::Wide, _) => 0,
        }
    }

    /// The pattern of its mesh.
    pub const fn pattern(self) -> &'static Pattern {
        match self {
            Self::Baseball => &baseball::PATTERN,
            Self::Bucket => &bucket::PATTERN,
            Self::Visor => &visor::PATTERN,
            Self::Flat => &flat::PATTERN,
            Self::Beanie => &beanie::PATTERN,
        }
    }

    /// Whether a turn about the vertical leaves it what it is.
    pub const fn symmetry(self) -> Symmetry {
        match self {
            Self::Bucket | Self::Beanie => Symmetry::Round,
            Self::Baseball | Self::Visor | Self::Flat => Symmetry::None,
        }
    }
}

impl Pattern {
    /// Whether the crown has no top.
    pub fn is_open(&self) -> bool {
        self.open > 0.0
    }

    /// The innermost ring of vertices that the crown has.
    pub fn first_ring(&self, resolution: Resolution) -> usize {
        (self.open * resolution.rings() as f64).round() as usize
    }

    /// Hem vertices on each side of the middle that a front brim reaches.
    pub fn front_reach(&self, resolution: Resolution) -> Option<isize> {
        match self.brim {
            BrimPattern::Front { reach, .. } => {
                Some((reach * resolution.hem() as f64).round() as isize)
            }
            BrimPattern::None | BrimPattern::Round { .. } => None,
        }
    }
}
