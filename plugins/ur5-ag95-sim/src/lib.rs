//! The simulated robots: a UR5 with an AG-95 gripper that moves the simulated cell's hand.
//!
//! Two implementations of kind `robot`: `ur5-ag95-sim`, whose joint servos lag behind
//! their commands as real ones do, and `ideal-sim`, which tracks exactly and so tells an
//! error of the plan from one of the servos.

mod servo;

use seeone_core::robot::RobotModel;
use seeone_plugin::{
    Action, Felt, GripperCommand, JointTrajectory, PluginError, Robot, RobotSample, RobotState,
    Setup, Watch, World,
};
use seeone_sim::cell::FRAME_S;
use serde::Deserialize;
use servo::Servo;
use std::sync::Arc;

/// The first command may be this far from where the joints are, radians.
const START_TOLERANCE_RAD: f64 = 0.02;
/// The slowest grip takes this long, seconds: full stroke at the gripper's speed, twice.
const GRIP_LIMIT_S: f64 = 4.0;
/// Frames between two samples for the watcher: thirty a second.
const FRAMES_PER_SAMPLE: usize = 2;

/// The plugin's own table.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Configuration {
    /// Time constant of the joint servos, seconds.
    servo_lag_s: f64,
}

impl Default for Configuration {
    fn default() -> Self {
        Self { servo_lag_s: 0.02 }
    }
}

/// A simulated arm with a gripper.
pub struct SimulatedArm {
    world: Arc<dyn World>,
    model: RobotModel,
    servo: Servo,
    joints: Vec<f64>,
}

impl SimulatedArm {
    /// `ur5-ag95-sim`: with servo lag.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for an unknown key, a lag that is negative or not
    /// finite, or a cell that is not simulated.
    pub fn lagging(setup: &Setup) -> Result<Self, PluginError> {
        let configuration: Configuration = setup.configuration()?;
        Self::with_servo(setup, Servo::new(configuration.servo_lag_s)?)
    }

    /// `ideal-sim`: exact tracking.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for any key, or a cell that is not simulated.
    pub fn ideal(setup: &Setup) -> Result<Self, PluginError> {
        match setup.config.keys().next() {
            Some(key) => Err(PluginError::Configuration(format!(
                "ideal-sim takes no table, found \"{key}\""
            ))),
            None => Self::with_servo(setup, Servo::new(0.0)?),
        }
    }

    fn with_servo(setup: &Setup, servo: Servo) -> Result<Self, PluginError> {
        let model = setup.robot()?.clone();
        let joints = model.home().to_vec();
        let arm = Self { world: setup.world()?, model, servo, joints };
        let pose = arm.model.tool_pose(&arm.joints);
        arm.world.place_hand(&pose)?;
        Ok(arm)
    }

    /// Follows a trajectory to its end or, with a force of contact in newtons, until the
    /// load of what is held has changed by so much or has slipped off the pads; says whether
    /// it has.
    fn follow(
        &mut self,
        trajectory: &JointTrajectory,
        contact_n: Option<f64>,
        watch: &mut Watch,
    ) -> Result<bool, PluginError> {
        trajectory.check_from(&self.model, &self.joints, START_TOLERANCE_RAD)?;
        if let Some(force_n) = contact_n
            && !(force_n.is_finite() && force_n > 0.0)
        {
            return Err(PluginError::Input(format!("contact with {force_n} N is none")));
        }
        let before = self.world.state()?;
        if contact_n.is_some() && !before.pads_feel_load {
            let cause = "the simulated wrist feels only the load of what is held";
            return Err(PluginError::Input(cause.into()));
        }
        let frames = (trajectory.duration_s() / FRAME_S).ceil() as usize + self.servo.tail_frames();
        for frame in 1..=frames {
            let Some(command) = trajectory.at(frame as f64 * FRAME_S) else { break };
            self.servo.track(&mut self.joints, &command);
            let pose = self.model.tool_pose(&self.joints);
            self.world.advance(&pose)?;
            let now = self.world.state()?;
            let change = (now.load_n - before.load_n).norm();
            let slipped = !now.pads_feel_load;
            let contact = contact_n.is_some_and(|force_n| change > force_n || slipped);
            if frame % FRAMES_PER_SAMPLE == 0 || frame == frames || contact {
                watch(&self.sample()?)?;
            }
            if contact {
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn grip(&mut self, command: GripperCommand, watch: &mut Watch) -> Result<(), PluginError> {
        self.world.grip(command)?;
        let pose = self.model.tool_pose(&self.joints);
        for frame in 0..(GRIP_LIMIT_S / FRAME_S) as usize {
            self.world.advance(&pose)?;
            let moving = self.world.state()?.fingers_move;
            if frame % FRAMES_PER_SAMPLE == 0 {
                watch(&self.sample()?)?;
            }
            if !moving {
                break;
            }
        }
        Ok(())
    }

    fn sample(&self) -> Result<RobotSample, PluginError> {
        let now = self.world.state()?;
        let state = RobotState { joints: self.joints.clone(), opening_m: now.opening_m };
        Ok(RobotSample { time_s: now.time_s, state })
    }
}

impl Robot for SimulatedArm {
    fn state(&mut self) -> Result<RobotState, PluginError> {
        Ok(self.sample()?.state)
    }

    fn execute(&mut self, action: &Action, watch: &mut Watch) -> Result<Felt, PluginError> {
        let contact = match action {
            Action::Move(trajectory) => self.follow(trajectory, None, watch)?,
            Action::MoveUntilContact { trajectory, force_n } => {
                self.follow(trajectory, Some(*force_n), watch)?
            }
            Action::Grip(command) => {
                self.grip(*command, watch)?;
                false
            }
        };
        let now = self.world.state()?;
        Ok(Felt { opening_m: now.opening_m, holding: now.pads_feel_load, contact })
    }

    /// The simulated arm moves in `execute` alone, and holds its position by itself.
    fn stop(&mut self) -> Result<(), PluginError> {
        self.world.state().map(drop)
    }
}
