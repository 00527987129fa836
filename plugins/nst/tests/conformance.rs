//! Both perceptions keep the rules of their kind, with the shipped weights.

use seeone_plugin::{Setup, conformance};
use std::path::Path;

#[test]
fn both_perceptions_conform() {
    let config = toml::toml! { weights = "weights" };
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let setup = Setup { config: &config, root, seed: 0, world: None, robot: None };
    let mut full = seeone_nst::build(&setup).expect("the shipped weights");
    conformance::perception(&mut full).expect("conforms");
    let mut once = seeone_nst::build_one_pass(&setup).expect("the shipped weights");
    conformance::perception(&mut once).expect("conforms");
}
