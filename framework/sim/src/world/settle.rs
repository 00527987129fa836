//! Waiting until the object rests.

use super::{FRAME_S, World};
use nalgebra::Point3;

/// Speed below which a shell is at rest, m/s.
const REST_SPEED_M_S: f64 = 0.010;
/// How long it must stay below it, in frames (0.25 s).
const REST_FRAMES: usize = 15;
/// Or no vertex leaves its place by more than this, metres, ...
const PLACE_M: f64 = 1.0e-4;
/// ... for so many frames (1 s).
const PLACE_FRAMES: usize = 60;

/// Tells from frame to frame whether an object rests: whether for 0.25 s it was slower than
/// 10 mm/s, or for a second kept each vertex within 0.1 mm of its place.
///
/// The second because a vertex that one contact presses into another has a speed that every
/// substep gives and the next takes back; it goes nowhere.
#[derive(Clone, Debug, Default)]
pub struct Rest {
    /// For how many frames it was slow, in deformation and in all motion.
    steady: usize,
    slow: usize,
    /// For how many frames it has kept its place.
    kept: usize,
    place: Vec<Point3<f64>>,
    /// Still, and nowhere gone through itself: what is tangled is yet to be led out.
    whole: bool,
}

impl Rest {
    /// Looks at the frame that `world` has just finished.
    pub fn look(&mut self, world: &World) {
        let went_on = world.fault().is_none();
        let counted = |so: bool, frames: usize| if so && went_on { frames + 1 } else { 0 };
        let steady = world.deformation_rms_speed() < REST_SPEED_M_S;
        self.steady = counted(steady, self.steady);
        self.slow = counted(steady && world.rms_speed() < REST_SPEED_M_S, self.slow);
        let near = |(a, b): (&Point3<f64>, &Point3<f64>)| (a - b).norm() < PLACE_M;
        let now = world.vertices();
        let kept = self.place.len() == now.len() && self.place.iter().zip(now).all(near);
        self.kept = counted(kept, self.kept);
        if !kept {
            self.place = now.to_vec();
        }
        self.whole = self.is_still() && world.crossings() == 0;
    }

    /// Whether it no longer deforms.
    pub fn of_shape(&self) -> bool {
        self.steady >= REST_FRAMES || self.kept >= PLACE_FRAMES
    }

    /// Whether it no longer moves at all.
    pub fn of_all(&self) -> bool {
        self.whole
    }

    fn is_still(&self) -> bool {
        self.slow >= REST_FRAMES || self.kept >= PLACE_FRAMES
    }
}

/// How a settling ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settled {
    /// How long it took, s.
    pub seconds: f64,
    /// Whether the object came to rest within the limit.
    pub at_rest: bool,
}

impl World {
    /// Advances until the object [`Rest`]s, or until `limit_s` seconds have passed.
    pub fn settle(&mut self, limit_s: f64) -> Settled {
        let limit = (limit_s / FRAME_S).round().max(0.0) as usize;
        let mut rest = Rest::default();
        for frame in 1..=limit {
            self.advance();
            rest.look(self);
            if rest.of_all() {
                return Settled { seconds: frame as f64 * FRAME_S, at_rest: true };
            }
        }
        Settled { seconds: limit as f64 * FRAME_S, at_rest: false }
    }
}
