//! `my-plugin`, a plugin of kind `robot`: an arm that carries the hand of the simulated world
//! exactly where it is told. For a real arm, talk to its controller instead of the world.

use seeone_core::robot::RobotModel;
use seeone_plugin::{
    Action, Felt, GripperCommand, JointTrajectory, PluginError, Robot, RobotSample, RobotState,
    Setup, Watch, World,
};
use serde::Deserialize;
use std::sync::Arc;

seeone_plugin::export_plugins! {
    Robot "my-plugin" => MyPlugin::from_setup,
}

/// The table in a robot file, `[config.robot]`.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Configuration {
    /// How far from where the arm is a trajectory may begin, radians.
    start_tolerance_rad: f64,
}

impl Default for Configuration {
    fn default() -> Self {
        Self { start_tolerance_rad: 0.02 }
    }
}

/// An arm in the simulated world.
pub struct MyPlugin {
    world: Arc<dyn World>,
    model: RobotModel,
    joints: Vec<f64>,
    start_tolerance_rad: f64,
}

/// A grip takes no longer than this, seconds.
const GRIP_LIMIT_S: f64 = 4.0;

impl MyPlugin {
    /// From its table, its robot and its world.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for an unknown key, a number out of range, or a cell
    /// without robot or world.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        let Configuration { start_tolerance_rad } = setup.configuration()?;
        if !(start_tolerance_rad > 0.0 && start_tolerance_rad <= 0.1) {
            let told = format!("start_tolerance_rad is {start_tolerance_rad}, not up to 0.1");
            return Err(PluginError::Configuration(told));
        }
        let model = setup.robot()?.clone();
        let (world, joints) = (setup.world()?, model.home().to_vec());
        world.place_hand(&model.tool_pose(&joints))?;
        Ok(Self { world, model, joints, start_tolerance_rad })
    }

    /// Moves the hand to where the joints are, for one frame.
    fn frame(&self, watch: &mut Watch) -> Result<(), PluginError> {
        self.world.advance(&self.model.tool_pose(&self.joints))?;
        let now = self.world.state()?;
        let state = RobotState { joints: self.joints.clone(), opening_m: now.opening_m };
        watch(&RobotSample { time_s: now.time_s, state })
    }

    /// Follows a trajectory; says whether contact ended it.
    fn follow(
        &mut self,
        trajectory: &JointTrajectory,
        contact_n: Option<f64>,
        watch: &mut Watch,
    ) -> Result<bool, PluginError> {
        trajectory.check_from(&self.model, &self.joints, self.start_tolerance_rad)?;
        let before = self.world.state()?;
        let frames = (trajectory.duration_s() / before.frame_s).ceil().max(1.0) as usize;
        for frame in 1..=frames {
            if let Some(joints) = trajectory.at(frame as f64 * before.frame_s) {
                self.joints = joints;
            }
            self.frame(watch)?;
            let now = self.world.state()?;
            let change = (now.load_n - before.load_n).norm();
            let slipped = before.pads_feel_load && !now.pads_feel_load;
            if contact_n.is_some_and(|force_n| change > force_n || slipped) {
                return Ok(true);
            }
        }
        Ok(false)
    }

    fn grip(&mut self, command: GripperCommand, watch: &mut Watch) -> Result<(), PluginError> {
        self.world.grip(command)?;
        let frame_s = self.world.state()?.frame_s;
        for _ in 0..(GRIP_LIMIT_S / frame_s) as usize {
            self.frame(watch)?;
            if !self.world.state()?.fingers_move {
                break;
            }
        }
        Ok(())
    }
}

impl Robot for MyPlugin {
    fn state(&mut self) -> Result<RobotState, PluginError> {
        let opening_m = self.world.state()?.opening_m;
        Ok(RobotState { joints: self.joints.clone(), opening_m })
    }

    fn execute(&mut self, action: &Action, watch: &mut Watch) -> Result<Felt, PluginError> {
        let contact = match action {
            Action::Move(trajectory) => self.follow(trajectory, None, watch)?,
            Action::MoveUntilContact { trajectory, force_n } => {
                if !(force_n.is_finite() && *force_n > 0.0) {
                    return Err(PluginError::Input(format!("contact with {force_n} N is none")));
                }
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

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_plugin::conformance::{self, StillWorld, arm};
    use std::path::Path;

    #[test]
    fn conforms() {
        let (config, model) = (Default::default(), arm());
        let build = || -> Result<Box<dyn Robot>, PluginError> {
            let world: Arc<dyn World> = Arc::new(StillWorld::default());
            let (root, robot) = (Path::new("."), Some(&model));
            let setup = Setup { config: &config, root, seed: 0, robot, world: Some(world) };
            Ok(Box::new(MyPlugin::from_setup(&setup)?))
        };
        conformance::robot(&model, &build).expect("conforms");
    }
}
