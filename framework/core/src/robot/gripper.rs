//! A two-finger parallel gripper whose pads may move along the approach as they close.

use super::{Link, Solid};
use crate::Pose;
use nalgebra::{Translation3, Vector3};

/// What a URDF does not say about a gripper.
#[derive(Clone, Debug, PartialEq)]
pub struct GripperOptions {
    /// Smallest and largest grip force, newtons.
    pub force_n: [f64; 2],
    /// `(opening, reach)` in metres, openings rising: how far the finger tips are from
    /// the flange when the pads are that far apart. One entry when the reach is constant.
    pub reach_m: Vec<(f64, f64)>,
}

impl Default for GripperOptions {
    /// The DH-Robotics AG-95: 45 to 160 N; its four-bar fingers move forward by 16 mm
    /// while they close (its published width-length table, remodelled linkage).
    fn default() -> Self {
        Self {
            force_n: [45.0, 160.0],
            reach_m: vec![
                (0.0017, 0.2002),
                (0.0160, 0.2008),
                (0.0379, 0.1998),
                (0.0589, 0.1966),
                (0.0783, 0.1914),
                (0.0952, 0.1844),
            ],
        }
    }
}

/// One finger.
#[derive(Clone, Debug, PartialEq)]
pub struct Finger {
    /// Pose of the closed finger in the arm's last link.
    pub(super) closed: Pose,
    /// Where it moves to open, in its own frame.
    pub(super) axis: Vector3<f64>,
    pub(super) link: Link,
}

/// A palm with two fingers that open by equal amounts. Poses are in the arm's last link.
#[derive(Clone, Debug, PartialEq)]
pub struct GripperModel {
    pub(super) stroke_m: f64,
    pub(super) options: GripperOptions,
    pub(super) palm: Link,
    pub(super) fingers: [Finger; 2],
    /// Direction of approach (tool z) in the last link.
    pub(super) approach: Vector3<f64>,
}

impl GripperModel {
    /// Largest distance between the pads, metres.
    pub fn stroke_m(&self) -> f64 {
        self.stroke_m
    }

    /// What it was made with beside the URDF.
    pub fn options(&self) -> &GripperOptions {
        &self.options
    }

    /// Smallest and largest grip force, newtons.
    pub fn force_range_n(&self) -> [f64; 2] {
        self.options.force_n
    }

    /// Distance of the finger tips from the flange with the pads `opening_m` apart,
    /// metres; linear between the table's entries and constant beyond them.
    pub fn reach_m(&self, opening_m: f64) -> f64 {
        let table = &self.options.reach_m;
        let after = table.partition_point(|(opening, _)| *opening < opening_m);
        match (after.checked_sub(1).and_then(|i| table.get(i)), table.get(after)) {
            (Some((o0, r0)), Some((o1, r1))) => r0 + (r1 - r0) * (opening_m - o0) / (o1 - o0),
            (Some((_, reach)), None) | (None, Some((_, reach))) => *reach,
            (None, None) => 0.0,
        }
    }

    /// What the palm may not put into something else.
    pub fn palm_collision(&self) -> &[Solid] {
        &self.palm.collision
    }

    /// What the fingers may not put into something else, with the pads `opening_m` apart.
    pub fn finger_collision(&self, opening_m: f64) -> Vec<Solid> {
        self.placed_fingers(opening_m, |link| &link.collision)
    }

    /// What palm and fingers look like with the pads `opening_m` apart.
    pub fn visual(&self, opening_m: f64) -> Vec<Solid> {
        let mut solids = self.palm.visual.clone();
        solids.extend(self.placed_fingers(opening_m, |link| &link.visual));
        solids
    }

    /// Poses of the two fingers in the last link with the pads `opening_m` apart.
    pub fn finger_poses(&self, opening_m: f64) -> [Pose; 2] {
        let opening_m = opening_m.clamp(0.0, self.stroke_m);
        let forward = self.approach * (self.reach_m(opening_m) - self.reach_m(0.0));
        self.fingers.each_ref().map(|finger| {
            let open = Translation3::from(finger.axis * (0.5 * opening_m));
            Translation3::from(forward) * finger.closed * open
        })
    }

    fn placed_fingers(&self, opening_m: f64, which: impl Fn(&Link) -> &Vec<Solid>) -> Vec<Solid> {
        let poses = self.finger_poses(opening_m);
        let fingers = self.fingers.iter().zip(poses);
        fingers
            .flat_map(|(finger, pose)| {
                which(&finger.link)
                    .iter()
                    .map(move |solid| Solid { pose: pose * solid.pose, ..solid.clone() })
            })
            .collect()
    }
}
