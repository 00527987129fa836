//! Waiting until the object rests.

use super::{FRAME_S, World};

/// Speed below which a shell is at rest, m/s.
const REST_SPEED_M_S: f64 = 0.010;
/// How long it must stay below it, in frames (0.25 s).
const REST_FRAMES: usize = 15;
/// How a settling ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settled {
    /// How long it took, s.
    pub seconds: f64,
    /// Whether the object came to rest within the limit.
    pub at_rest: bool,
}

impl World {
    /// Advances until the object rests: below 10 mm/s, both overall and in deformation,
    /// for 0.25 s; or until `limit_s` seconds have passed.
    pub fn settle(&mut self, limit_s: f64) -> Settled {
        let limit = (limit_s / FRAME_S).round().max(0.0) as usize;
        let mut calm = 0;
        for frame in 1..=limit {
            self.advance();
            let resting = self.fault.is_none()
                && self.rms_speed() < REST_SPEED_M_S
                && self.deformation_rms_speed() < REST_SPEED_M_S;
            calm = if resting { calm + 1 } else { 0 };
            if calm >= REST_FRAMES {
                return Settled { seconds: frame as f64 * FRAME_S, at_rest: true };
            }
        }
        Settled { seconds: limit as f64 * FRAME_S, at_rest: false }
    }
}
