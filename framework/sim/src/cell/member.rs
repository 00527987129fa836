//! One object of a cell, in a world that holds it alone.

use crate::hand::Hand;
use crate::object::Object;
use crate::world::World;
use nalgebra::Point3;

/// An object and the world around it.
#[derive(Clone, Debug)]
pub(super) struct Member {
    pub(super) object: Object,
    pub(super) world: World,
    /// Whether it hung by itself when it was last judged, and has not been taken since.
    pub(super) hung: bool,
}

impl Member {
    pub(super) fn new(object: Object, world: World) -> Self {
        Self { object, world, hung: false }
    }

    /// One frame, at whose end the hand is as `hand` says.
    pub(super) fn advance(&mut self, hand: &Hand) {
        self.world.move_hand(hand);
        self.world.advance();
    }

    /// Whether the hand holds it.
    pub(super) fn is_held(&self) -> bool {
        self.world.hand_state().held_points > 0
    }

    /// Whether any vertex of it is nearer than `gap_m` to one of `other`.
    pub(super) fn is_near(&self, other: &Self, gap_m: f64) -> bool {
        let (here, there) = (self.world.vertices(), other.world.vertices());
        let ([low, high], [from, to]) = (bounds(here), bounds(there));
        let apart = (0..3).any(|i| low[i] > to[i] + gap_m || from[i] > high[i] + gap_m);
        !apart && here.iter().any(|p| there.iter().any(|q| (p - q).norm() < gap_m))
    }
}

/// The lowest and the highest coordinates of some points.
fn bounds(points: &[Point3<f64>]) -> [Point3<f64>; 2] {
    let start = [Point3::from([f64::INFINITY; 3]), Point3::from([f64::NEG_INFINITY; 3])];
    points.iter().fold(start, |[low, high], p| [low.inf(p), high.sup(p)])
}
