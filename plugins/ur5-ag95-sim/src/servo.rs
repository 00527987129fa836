//! Joint servos that follow their commands with a first-order lag.

use seeone_plugin::PluginError;
use seeone_sim::cell::FRAME_S;

/// After this many time constants what is left of a step is below one part in a thousand.
const TAIL_TIME_CONSTANTS: f64 = 7.0;

/// All servos of an arm; they share one time constant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Servo {
    /// Share of the remaining way that is covered in one frame.
    share: f64,
    tail_frames: usize,
}

impl Servo {
    /// Servos with this time constant in seconds; zero tracks exactly.
    pub(crate) fn new(lag_s: f64) -> Result<Self, PluginError> {
        if !(lag_s.is_finite() && (0.0..=1.0).contains(&lag_s)) {
            return Err(PluginError::Configuration(format!(
                "servo_lag_s = {lag_s} is not between 0 and 1"
            )));
        }
        let share = if lag_s == 0.0 { 1.0 } else { 1.0 - (-FRAME_S / lag_s).exp() };
        Ok(Self { share, tail_frames: (TAIL_TIME_CONSTANTS * lag_s / FRAME_S).ceil() as usize })
    }

    /// Moves `joints` towards `command` for one frame.
    pub(crate) fn track(&self, joints: &mut [f64], command: &[f64]) {
        for (joint, wanted) in joints.iter_mut().zip(command) {
            *joint += self.share * (wanted - *joint);
        }
    }

    /// Frames to go on tracking after a trajectory's last sample.
    pub(crate) fn tail_frames(&self) -> usize {
        self.tail_frames
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lagging_servo_arrives_within_its_tail_and_an_ideal_one_at_once() {
        let mut joints = vec![0.0];
        let lagging = Servo::new(0.02).expect("valid");
        lagging.track(&mut joints, &[1.0]);
        assert!(joints[0] > 0.4 && joints[0] < 0.9);
        (0..lagging.tail_frames()).for_each(|_| lagging.track(&mut joints, &[1.0]));
        assert!((joints[0] - 1.0).abs() < 2e-3);
        let mut exact = vec![0.0];
        Servo::new(0.0).expect("valid").track(&mut exact, &[1.0]);
        assert_eq!(exact, [1.0]);
    }

    #[test]
    fn refuses_a_lag_that_is_none() {
        assert!(Servo::new(f64::NAN).is_err() && Servo::new(-0.1).is_err());
    }
}
