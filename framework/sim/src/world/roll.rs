//! Rolling friction: what ends the rocking of an object on its round side.

use super::World;
use crate::shell::Momentum;

/// Lever arm of the rolling resistance, metres: a dome of fabric on a soft surface flattens
/// by about this much more in front of the contact than behind it.
const ROLLING_ARM_M: f64 = 5.0e-4;

impl World {
    /// Brakes the spin of a free object by the torque of its support in this frame: the
    /// impulse `given` by what it lies on, times the arm, and never beyond a standstill.
    pub(super) fn resist_rolling(&mut self, given: &Momentum) {
        if self.grasp.is_none() {
            self.shell.brake_spin(given.linear.norm() * ROLLING_ARM_M);
        }
    }
}
