//! Plugins that do nothing, for the benchmark of what crossing the ABI costs.

use seeone_plugin::{
    Action, CanonicalCloud, Felt, Observation, Perception, PluginError, Robot, RobotState, Setup,
    Watch,
};
use std::hint::black_box;

seeone_plugin::export_plugins! {
    Perception "idle" => Idle::from_setup,
    Robot "idle" => Idle::from_setup,
}

struct Idle;

impl Idle {
    fn from_setup(_: &Setup) -> Result<Self, PluginError> {
        Ok(Self)
    }
}

impl Perception for Idle {
    fn perceive(&mut self, observation: &Observation) -> Result<CanonicalCloud, PluginError> {
        black_box(observation.cloud.points());
        Ok(CanonicalCloud::default())
    }
}

impl Robot for Idle {
    fn state(&mut self) -> Result<RobotState, PluginError> {
        Ok(RobotState { joints: vec![0.0; 6], opening_m: 0.0 })
    }

    fn execute(&mut self, _: &Action, _: &mut Watch) -> Result<Felt, PluginError> {
        Ok(Felt { opening_m: 0.0, holding: false, contact: false })
    }

    fn stop(&mut self) -> Result<(), PluginError> {
        Ok(())
    }
}
