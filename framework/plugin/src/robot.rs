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

impl RobotState {
    /// Says what no robot of so many `joints`, where that is known, may answer.
    ///
    /// # Errors
    /// A sentence about another number of joints or a number that is not finite.
    pub fn check(&self, joints: Option<usize>) -> Result<(), String> {
        match joints {
            Some(joints) if joints != self.joints.len() => {
                return Err(format!("{} joints of a robot with {joints}", self.joints.len()));
            }
            _ => {}
        }
        if !self.joints.iter().chain([&self.opening_m]).all(|v| v.is_finite()) {
            return Err(format!("the robot's state is not finite: {self:?}"));
        }
        Ok(())
    }
}

/// One moment of an execution.
#[derive(Clone, Debug, PartialEq)]
pub struct RobotSample {
    /// Seconds since the cell's clock started.
    pub time_s: f64,
    /// Where the robot was.
    pub state: RobotState,
}

impl RobotSample {
    /// Says what no robot of so many `joints`, where that is known, may show.
    ///
    /// # Errors
    /// As [`RobotState::check`], and about a time that is not finite.
    pub fn check(&self, joints: Option<usize>) -> Result<(), String> {
        if !self.time_s.is_finite() {
            return Err(format!("a sample's time is {} s", self.time_s));
        }
        self.state.check(joints)
    }
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

impl Felt {
    /// Says what no robot may answer.
    ///
    /// # Errors
    /// A sentence about an opening that is none.
    pub fn check(&self) -> Result<(), String> {
        let sound = self.opening_m.is_finite();
        if sound { Ok(()) } else { Err(format!("the fingers are {} m apart", self.opening_m)) }
    }
}

/// Sees the robot on its way, and may end it: by an error, after which the robot has to stop.
pub type Watch<'a> = dyn FnMut(&RobotSample) -> Result<(), PluginError> + Send + 'a;

/// A robot arm with a gripper.
pub trait Robot: Send {
    /// Where it is now.
    ///
    /// # Errors
    /// When the robot does not answer.
    fn state(&mut self) -> Result<RobotState, PluginError>;

    /// Carries out one action, to its end or to the contact it waits for, and says what was
    /// felt; `watch` sees the robot about thirty times a second on the way. An error of `watch`
    /// ends the action there and then, with that error and the robot at a stop.
    ///
    /// # Errors
    /// When the first sample is not where the robot is, a sample breaks a limit, a number
    /// is not finite, or the robot stopped on the way.
    fn execute(&mut self, action: &Action, watch: &mut Watch) -> Result<Felt, PluginError>;

    /// Stands still: whatever is under way ends, the arm holds the position that it is in, and
    /// the hand keeps what it holds. The host asks for it when a run has failed or was
    /// interrupted; a robot that stands stays as it is.
    ///
    /// # Errors
    /// When the robot does not answer, and may be moving.
    fn stop(&mut self) -> Result<(), PluginError>;
}
