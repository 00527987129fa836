//! Both solvers keep the rules of their kind.

use seeone_plugin::{Setup, conformance};
use seeone_qp_ik::{DampedLeastSquares, QpIk};
use std::path::Path;

#[test]
fn both_solvers_conform() {
    let config = toml::Table::new();
    let setup = Setup { config: &config, root: Path::new("."), seed: 3, world: None, robot: None };
    conformance::kinematics(&QpIk::from_setup(&setup).expect("defaults")).expect("conforms");
    let damped = DampedLeastSquares::from_setup(&setup).expect("defaults");
    conformance::kinematics(&damped).expect("conforms");
}
