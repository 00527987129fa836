//! The straight lines and grips around key poses, on one branch of the arm.

use crate::MotionConfig;
use crate::candidates::limit_cost;
use crate::failure::{Failure, StageFailure};
use crate::hand::Hand;
use crate::line::Line;
use nalgebra::{Translation3, Vector3};
use seeone_collision::{Checker, Convex, Rules};
use seeone_core::Pose;
use seeone_core::robot::RobotModel;
use seeone_plugin::motion::Obstacle;
use seeone_plugin::{GripperCommand, KeyPose, Kinematics};

/// One line or grip of a walk.
pub(crate) struct Leg<'a> {
    pub(crate) stage: &'a str,
    pub(crate) purpose: &'static str,
    pub(crate) deed: Deed,
}

/// What a leg does.
pub(crate) enum Deed {
    /// Run through these closely spaced postures; slowly near the first, the last, or both.
    Line { path: Vec<Vec<f64>>, slow_start: bool, slow_end: bool },
    /// Run through these until contact with this force, newtons.
    Guarded { path: Vec<Vec<f64>>, force_n: f64 },
    /// Move the fingers.
    Grip(GripperCommand),
}

/// What a walk needs to know.
pub(crate) struct Walker<'a> {
    pub(crate) robot: &'a RobotModel,
    pub(crate) kinematics: &'a dyn Kinematics,
    pub(crate) config: &'a MotionConfig,
    pub(crate) obstacles: &'a [Obstacle],
    /// What is between the fingers once they have closed.
    pub(crate) carried: Option<&'a Convex>,
    /// Key poses joined by straight lines, at least one.
    pub(crate) keys: &'a [KeyPose],
    /// The hand on the way to the first.
    pub(crate) hand: Hand,
}

/// A walk that can be done.
pub(crate) struct Walk<'a> {
    pub(crate) legs: Vec<Leg<'a>>,
    pub(crate) entry: Vec<f64>,
    pub(crate) exit: Vec<f64>,
    pub(crate) limit_cost: f64,
}

impl<'a> Walker<'a> {
    /// Whether nothing lies between two key poses, so that a straight line joins them.
    pub(crate) fn joins(before: &KeyPose, after: &KeyPose) -> bool {
        before.lift_m == 0.0 && before.retreat_m == 0.0 && after.approach_m == 0.0
    }

    /// Whether the arm may stand at `q` at a key pose.
    ///
    /// # Errors
    /// What it would touch.
    pub(crate) fn stands(&self, q: &[f64]) -> Result<(), Failure> {
        let (checker, tool) = (self.checker(&self.hand), self.robot.tool_pose(q));
        let room = checker.room([&tool, &tool]);
        let rules = Rules { fingers_may_touch: true, room: Some(&room) };
        match checker.contact_under(q, &rules) {
            Some(contact) => Err(Failure::Infeasible(contact.to_string())),
            None => Ok(()),
        }
    }

    /// Walks all key poses with the arm at `first` at the first of them.
    ///
    /// # Errors
    /// The stage and line that cannot be followed, and why.
    pub(crate) fn walk(&self, first: &[f64]) -> Result<Walk<'a>, StageFailure> {
        let mut walk = Walk {
            legs: Vec::new(),
            entry: first.to_vec(),
            exit: first.to_vec(),
            limit_cost: limit_cost(self.robot, first),
        };
        let mut hand = self.hand;
        for (index, key) in self.keys.iter().enumerate() {
            if index > 0 {
                let path = self.line(key, "approach", &walk.exit, &key.pose, &hand)?;
                walk.limit_cost += limit_cost(self.robot, &path[path.len() - 1]);
                walk.approach(key, path);
            } else if key.approach_m > 0.0 {
                // Followed backwards, from where the branch is known.
                let back = key.pose * Translation3::new(0.0, 0.0, -key.approach_m);
                let mut path = self.line(key, "approach", first, &back, &hand)?;
                path.reverse();
                walk.entry.clone_from(&path[0]);
                walk.approach(key, path);
            }
            if let Some(command) = key.gripper {
                walk.push(key, "grip", Deed::Grip(command));
                hand = hand.after(key.gripper);
            }
            let lifted = Translation3::from(Vector3::z() * key.lift_m) * key.pose;
            let retreated = lifted * Translation3::new(0.0, 0.0, -key.retreat_m);
            let departures = [("lift", key.lift_m, lifted), ("retreat", key.retreat_m, retreated)];
            for (purpose, length, target) in departures {
                if length > 0.0 {
                    let path = self.line(key, purpose, &walk.exit, &target, &hand)?;
                    walk.push(key, purpose, Deed::Line { path, slow_start: true, slow_end: false });
                }
            }
        }
        Ok(walk)
    }

    /// What the hand in this state touches.
    pub(crate) fn checker(&self, hand: &Hand) -> Checker<'a> {
        let (margins, obstacles) = (self.config.margins(), self.obstacles);
        let checker = Checker::new(self.robot, margins, obstacles, hand.opening_m);
        match self.carried {
            Some(shape) if hand.holding => checker.carrying(shape.clone()),
            _ => checker,
        }
    }

    /// A line that touches nothing but, with the fingers, near the key poses, and with what is
    /// carried what that touches at the ends.
    fn line(
        &self,
        key: &KeyPose,
        purpose: &str,
        start: &[f64],
        target: &Pose,
        hand: &Hand,
    ) -> Result<Vec<Vec<f64>>, StageFailure> {
        let checker = self.checker(hand);
        let room = checker.room([&self.robot.tool_pose(start), target]);
        let fault = |q: &[f64]| {
            let tool = self.robot.tool_pose(q).translation.vector;
            let mut distances =
                self.keys.iter().map(|key| (key.pose.translation.vector - tool).norm());
            let near = distances.any(|distance| distance <= self.config.finger_zone_m + 1e-6);
            let rules = Rules { fingers_may_touch: near, room: Some(&room) };
            checker.contact_under(q, &rules).map(|contact| contact.to_string())
        };
        let (robot, kinematics, step_m) = (self.robot, self.kinematics, self.config.line_step_m);
        let line = Line { robot, kinematics, start, target, step_m, fault: &fault };
        line.follow().map_err(|failure| failure.at(&key.stage, purpose))
    }
}

impl<'a> Walk<'a> {
    fn approach(&mut self, key: &'a KeyPose, path: Vec<Vec<f64>>) {
        let deed = match key.until_contact_n {
            Some(force_n) => Deed::Guarded { path, force_n },
            None => Deed::Line { path, slow_start: false, slow_end: true },
        };
        self.push(key, "approach", deed);
    }

    fn push(&mut self, key: &'a KeyPose, purpose: &'static str, deed: Deed) {
        if let Deed::Line { path, .. } | Deed::Guarded { path, .. } = &deed {
            self.exit.clone_from(&path[path.len() - 1]);
        }
        self.legs.push(Leg { stage: &key.stage, purpose, deed });
    }
}
