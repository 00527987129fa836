//! Both planners keep the rules of their kind.

use seeone_motion::{JointLine, Planner};
use seeone_plugin::{Setup, conformance};
use std::path::Path;

#[test]
fn both_planners_conform() {
    let config = toml::Table::new();
    let setup = Setup { config: &config, root: Path::new("."), seed: 3, world: None, robot: None };
    conformance::motion(&Planner::from_setup(&setup).expect("defaults")).expect("conforms");
    conformance::motion(&JointLine::from_setup(&setup).expect("defaults")).expect("conforms");
}
