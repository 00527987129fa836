//! Equivalent grasps: the same surface between the same pads, the hand coming from
//! elsewhere.

use nalgebra::{Translation3, UnitQuaternion, Vector3};
use seeone_core::Pose;

/// Between two tried turns, degrees.
const STEP_DEG: u32 = 15;
/// Where no turn will do, the hand may come from above or below the surface that its pads hold, by
/// so many degrees: they press it askew, and what gives way lies in the hand a little otherwise
/// than was thought.
pub const TILTS_DEG: [f64; 5] = [0.0, 15.0, -15.0, 30.0, -30.0];

/// A way to turn the tool that leaves the grasp what it is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Turn {
    /// Turn about the closing axis (tool y), degrees.
    pub about_closing_deg: f64,
    /// Whether the fingers change places: half a turn about the approach axis (tool z).
    pub flipped: bool,
    /// Then the tilt about the pads' width (tool x), degrees.
    pub tilt_deg: f64,
}

impl Turn {
    /// The turned tool frame in the tool frame.
    pub fn pose(&self) -> Pose {
        let about_closing = UnitQuaternion::from_axis_angle(
            &Vector3::y_axis(),
            self.about_closing_deg.to_radians(),
        );
        let flip = if self.flipped { std::f64::consts::PI } else { 0.0 };
        let about_approach = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), flip);
        let tilt = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), self.tilt_deg.to_radians());
        Pose::from_parts(Translation3::identity(), about_closing * about_approach * tilt)
    }
}

/// The turns within `most_deg` either way, in steps of 15 degrees, the smallest first; a
/// parallel gripper is symmetric, so each also with the fingers exchanged. All with one tilt.
pub fn turns(most_deg: f64, tilt_deg: f64) -> Vec<Turn> {
    let steps = (most_deg.clamp(0.0, 180.0) / f64::from(STEP_DEG)).floor() as u32;
    let angles = (0..=steps).flat_map(|step| {
        let angle = f64::from(step * STEP_DEG);
        // Half a turn is the same either way.
        let back = (step > 0 && step * STEP_DEG < 180).then_some(-angle);
        [Some(angle), back].into_iter().flatten()
    });
    angles
        .flat_map(|about_closing_deg| {
            [false, true].map(|flipped| Turn { about_closing_deg, flipped, tilt_deg })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn begins_with_the_demonstrated_grasp_and_goes_outward() {
        let turns = turns(90.0, 0.0);
        assert_eq!(turns.len(), 26);
        assert_eq!(turns[0], Turn::default());
        assert_eq!(turns[0].pose(), Pose::identity());
        assert!(
            turns
                .windows(2)
                .all(|pair| { pair[0].about_closing_deg.abs() <= pair[1].about_closing_deg.abs() })
        );
        assert_eq!(super::turns(0.0, 0.0).len(), 2);
        assert_eq!(super::turns(14.9, 0.0).len(), 2);
        assert_eq!(super::turns(180.0, 0.0).len(), 48);
    }

    #[test]
    fn a_tilt_raises_the_approach_out_of_the_surface_and_keeps_the_pads_width_in_it() {
        for turn in turns(60.0, 15.0) {
            let pose = turn.pose();
            assert!((pose * Vector3::x()).y.abs() < 1e-12);
            let raised = (pose * Vector3::z()).y.abs();
            assert!((raised - 15f64.to_radians().sin()).abs() < 1e-12);
        }
    }

    #[test]
    fn keeps_the_line_along_which_the_fingers_close() {
        for turn in turns(180.0, 0.0) {
            let closing = turn.pose() * Vector3::y();
            let sign = if turn.flipped { -1.0 } else { 1.0 };
            assert!((closing - Vector3::y() * sign).norm() < 1e-12);
        }
    }
}
