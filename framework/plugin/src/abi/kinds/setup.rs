//! What a plugin is built from, as it crosses.

use crate::abi::cells::{Put, Reader, Take, fields, malformed, message};
use crate::{PluginError, Setup};
use seeone_core::robot::{GripperOptions, RobotDescription, RobotModel, RobotOptions};

/// A setup that has crossed, without the world, which is a service.
pub(in crate::abi) struct SetupMessage {
    /// The plugin's table as TOML.
    pub(in crate::abi) config: String,
    /// The folder against which it resolves paths.
    pub(in crate::abi) root: String,
    /// The seed of the run.
    pub(in crate::abi) seed: u64,
    /// The robot.
    pub(in crate::abi) robot: Option<RobotModel>,
}

fields!(SetupMessage { config, root, seed, robot });
fields!(GripperOptions { force_n, reach_m });
fields!(RobotOptions { base, tool_link, home, acceleration, jerk, unchecked_pairs, gripper });
fields!(RobotDescription { urdf, options });

/// As what it was made of: the URDF as it was written, and what that does not say.
impl Put for RobotModel {
    fn put(&self, to: &mut Vec<u64>) {
        self.description().put(to);
    }
}

impl Put for &RobotModel {
    fn put(&self, to: &mut Vec<u64>) {
        (**self).put(to);
    }
}

impl Take for RobotModel {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        RobotModel::from_description(&Take::take(from)?).map_err(|e| malformed(e.to_string()))
    }
}

/// The message of a setup.
pub(in crate::abi) fn setup_message(setup: &Setup) -> Result<Vec<u64>, PluginError> {
    let root = setup
        .root
        .to_str()
        .ok_or_else(|| PluginError::Configuration("the folder's path is not UTF-8".into()))?;
    Ok(message(&[&setup.config.to_string(), &root, &setup.seed, &setup.robot]))
}
