//! Both encodings keep the rules of their kind, the learned one with the shipped weights.

use seeone_plugin::{Setup, conformance};
use std::path::Path;

/// Features a point of the perception that the shipped weights were trained behind.
const WIDTH: usize = 128;

#[test]
fn both_encodings_conform() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let config = toml::toml! {
        weights = "weights"
        perception_weights = "../nst/weights"
    };
    let setup = Setup { config: &config, root, seed: 0, world: None, robot: None };
    let mut learned = seeone_nse::build(&setup).expect("the shipped weights");
    conformance::encoding(&mut learned, WIDTH).expect("conforms");
    let nothing = toml::Table::new();
    let setup = Setup { config: &nothing, ..setup };
    let mut nearest = seeone_nse::build_nearest_feature(&setup).expect("nothing to choose");
    conformance::encoding(&mut nearest, WIDTH).expect("conforms");
}
