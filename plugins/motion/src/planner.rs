//! The two plugins.

use crate::MotionConfig;
use crate::hand::Hand;
use crate::plan::Plan;
use crate::transit::{Style, transit};
use seeone_collision::{Checker, Convex};
use seeone_core::random::generator;
use seeone_core::robot::RobotModel;
use seeone_plugin::{
    GripperCommand, KeyPose, Kinematics, Motion, MotionOutcome, MotionTask, PluginError, Setup,
};

/// Plans around obstacles.
pub struct Planner(Planning);

/// Moves straight in joint space between the key poses' lines, or refuses.
pub struct JointLine(Planning);

struct Planning {
    config: MotionConfig,
    seed: u64,
    style: Style,
}

impl Planner {
    /// A planner with options and the seed of its random trees.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for a number without meaning.
    pub fn new(config: MotionConfig, seed: u64) -> Result<Self, PluginError> {
        Ok(Self(Planning { config: config.checked()?, seed, style: Style::Planned }))
    }

    /// From a configuration table with the fields of [`MotionConfig`].
    ///
    /// # Errors
    /// [`PluginError::Configuration`] when the table is wrong.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        Self::new(setup.configuration()?, setup.seed)
    }

    /// A free path of straight lines in joint space from `start` to `goal`, radians, among what
    /// `checker` knows.
    ///
    /// # Errors
    /// What is in the way.
    ///
    /// # Panics
    /// When an end has not one position a joint.
    pub fn free_path(
        &self,
        robot: &RobotModel,
        checker: &Checker,
        start: &[f64],
        goal: &[f64],
    ) -> Result<Vec<Vec<f64>>, String> {
        let Planning { config, seed, style } = &self.0;
        let mut rng = generator(*seed, "motion/free");
        transit(robot, config, checker, *style, (start, goal), &mut rng)
            .map_err(|failure| failure.to_string())
    }
}

impl JointLine {
    /// A planner with options.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for a number without meaning.
    pub fn new(config: MotionConfig, seed: u64) -> Result<Self, PluginError> {
        Ok(Self(Planning { config: config.checked()?, seed, style: Style::Straight }))
    }

    /// From a configuration table with the fields of [`MotionConfig`].
    ///
    /// # Errors
    /// [`PluginError::Configuration`] when the table is wrong.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        Self::new(setup.configuration()?, setup.seed)
    }
}

impl Motion for Planner {
    fn plan(
        &self,
        robot: &RobotModel,
        kinematics: &dyn Kinematics,
        task: &MotionTask,
    ) -> Result<MotionOutcome, PluginError> {
        self.0.plan(robot, kinematics, task)
    }
}

impl Motion for JointLine {
    fn plan(
        &self,
        robot: &RobotModel,
        kinematics: &dyn Kinematics,
        task: &MotionTask,
    ) -> Result<MotionOutcome, PluginError> {
        self.0.plan(robot, kinematics, task)
    }
}

impl Planning {
    fn plan(
        &self,
        robot: &RobotModel,
        kinematics: &dyn Kinematics,
        task: &MotionTask,
    ) -> Result<MotionOutcome, PluginError> {
        task.check(robot)?;
        let (config, seed, style) = (&self.config, self.seed, self.style);
        let key_poses = of_the_closed_hand(robot, task);
        let task = &MotionTask { key_poses: &key_poses, ..*task };
        let carried = Convex::hull(task.carried);
        let plan = Plan { config, seed, style, robot, kinematics, task, carried };
        match plan.solve() {
            Ok((program, cost)) => Ok(MotionOutcome::Planned { program, cost }),
            Err(failure) => failure.outcome(),
        }
    }
}

/// The key poses of the task as poses of the closed hand's tool, which the kinematics knows: a
/// hand that stays open at a pose has its pads further back. One that closes there meets the
/// pose with its pads closed, and so does one that holds something, which is thin.
fn of_the_closed_hand(robot: &RobotModel, task: &MotionTask) -> Vec<KeyPose> {
    let mut hand = Hand { opening_m: 0.0, holding: task.holding };
    let shifted = |key: &KeyPose| {
        hand = hand.approaching(key);
        let acting = if let Some(GripperCommand::Close { .. }) = key.gripper {
            hand.after(key.gripper)
        } else {
            hand
        };
        let opening_m = if acting.holding { 0.0 } else { acting.opening_m };
        hand = hand.after(key.gripper);
        let shift = robot.tool_at(opening_m).inverse() * robot.tool();
        KeyPose { pose: key.pose * shift, ..key.clone() }
    };
    task.key_poses.iter().map(shifted).collect()
}
