//! Kind `robot`: moves, and says where it is.

use crate::{Action, PluginError};

/// What the gripper shall do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GripperCommand {
    /// Close until the force is reached, newtons.
    Close {
        /// Grip force in newtons.
        force_n: f64,
    },
    /// Open to a distance between the pads, metres.
    Open {
        /// Distance between the pads, metres.
        opening_m: f64,
    },
}

/// Where the robot is.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotState {
    /// Joint positions, radians.
    pub joints: Vec<f64>,
    /// Distance between the pads, metres.
    pub opening_m: f64,
}

/// One moment of an execution.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotSample {
    /// Seconds since the cell's clock started.
    pub time_s: f64,
    /// Where the robot was.
    pub state: RobotState,
}

/// What the robot felt in an action: the gripper's own grip state, and the load at the wrist.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Felt {
    /// Distance between the pads, metres.
    pub opening_m: f64,
    /// Whether something is between the pads.
    pub holding: bool,
    /// Whether contact ended a move before its last sample: it met the force it was waiting
    /// for, or what was held has been pushed out of the hand.
    pub contact: bool,
}

/// A robot arm with a gripper.
pub trait Robot: Send {
    /// Where it is now.
    ///
    /// # Errors
    /// When the robot does not answer.
    fn state(&mut self) -> Result<RobotState, PluginError>;

    /// Carries out one action, to its end or to the contact it waits for, and says what was
    /// felt; `watch` sees the robot about thirty times a second on the way.
    ///
    /// # Errors
    /// When the first sample is not where the robot is, a sample breaks a limit, a number
    /// is not finite, or the robot stopped on the way.
    fn execute(
        &mut self,
        action: &Action,
        watch: &mut dyn FnMut(&RobotSample),
    ) -> Result<Felt, PluginError>;
}
