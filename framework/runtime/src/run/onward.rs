//! Going on from where contact ended a line: by the motion that was shown, not to the pose.

use crate::files::Stage;
use seeone_core::Pose;
use seeone_plugin::KeyPose;

/// The hand is at `here` in `world` instead of at the first of the key poses `ahead`: those whose
/// stage is reached by the motion that was shown are moved, so that it is the same motion from
/// wherever the one before them now leads.
pub(super) fn onward(stages: &[Stage], here: &Pose, ahead: &mut [KeyPose]) {
    let Some((first, rest)) = ahead.split_first_mut() else { return };
    let is_onward =
        |key: &KeyPose| stages.iter().any(|stage| stage.name == key.stage && stage.onward);
    let (mut before, mut reached) = (first.pose, *here);
    for key in rest {
        let shown = key.pose;
        if is_onward(key) {
            key.pose = shown * before.inverse() * reached;
        }
        (before, reached) = (shown, key.pose);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::RelativeTo;
    use nalgebra::Vector3;
    use seeone_core::pose::difference;

    fn stage(name: &str, pose: Pose, onward: bool) -> Stage {
        Stage { onward, ..Stage::through(name, RelativeTo::Frame("head".into()), pose) }
    }

    /// Down to a place, turned about a point beside it, drawn down; then to somewhere else.
    #[test]
    fn a_turn_about_a_point_stays_one_and_a_place_stays_where_it_is() {
        let centre = Pose::translation(0.3, 0.4, 0.2);
        let feel = Pose::new(Vector3::new(0.3, 0.3, 0.25), Vector3::new(0.0, 1.5, 0.2));
        let turn = centre * Pose::rotation(Vector3::x() * -0.2) * centre.inverse();
        let draw = Pose::translation(0.0, 0.0, -0.06);
        let away = Pose::translation(0.1, 0.1, 0.5);
        let stages = [
            stage("feel", feel, false),
            stage("level", turn * feel, true),
            stage("draw", draw * turn * feel, true),
            stage("away", away, false),
        ];
        let here = Pose::translation(0.01, 0.0, 0.04) * feel;
        let mut ahead: Vec<KeyPose> = stages.iter().map(|s| s.key_pose(s.gripper_pose)).collect();
        onward(&stages, &here, &mut ahead);
        let expected = [feel, turn * here, draw * turn * here, away];
        for (key, expected) in ahead.iter().zip(&expected) {
            let (metres, radians) = difference(&key.pose, expected);
            assert!(metres < 1e-12 && radians < 1e-7, "{}: {metres} {radians}", key.stage);
        }
    }
}
