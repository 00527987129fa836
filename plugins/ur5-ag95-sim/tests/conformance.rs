//! Both simulated robots keep the rules of their kind, in a world where nothing else happens.

use seeone_plugin::conformance::{self, StillWorld, arm};
use seeone_plugin::{PluginError, Robot, Setup};
use seeone_ur5_ag95_sim::SimulatedArm;
use std::path::Path;
use std::sync::Arc;

#[test]
fn both_robots_conform() {
    let (config, model) = (toml::Table::new(), arm());
    for make in [SimulatedArm::lagging, SimulatedArm::ideal] {
        let build = || -> Result<Box<dyn Robot>, PluginError> {
            let setup = Setup {
                config: &config,
                root: Path::new("."),
                seed: 0,
                robot: Some(&model),
                world: Some(Arc::new(StillWorld::default())),
            };
            Ok(Box::new(make(&setup)?))
        };
        conformance::robot(&model, &build).expect("conforms");
    }
}
