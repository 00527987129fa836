//! Both cameras keep the rules of their kind, and see what stands in the world.

use seeone_camera_sim::{RecordedCamera, SimulatedCamera};
use seeone_core::formats::ply::{Encoding, write_cloud};
use seeone_plugin::conformance::{self, StillWorld};
use seeone_plugin::{Camera, PluginError, Setup};
use std::sync::Arc;

/// A camera over the block, looking down.
const TABLE: &str = "
    pose = { xyz_m = [0.5, 0.0, 0.8], quat_xyzw = [1, 0, 0, 0] }
    intrinsics = { width = 160, height = 120, fx = 96, fy = 96, cx = 79.5, cy = 59.5 }
    crop = { centre_xy_m = [0.5, 0.0], half_extents_m = [0.25, 0.25], floor_m = 0.0, height_m = 0.4 }
    cloud = \"seen.ply\"
";

#[test]
fn both_cameras_conform() {
    let folder = tempfile::tempdir().expect("a folder");
    let config: toml::Table = TABLE.parse().expect("TOML");
    let setup = || Setup {
        config: &config,
        root: folder.path(),
        seed: 5,
        robot: None,
        world: Some(Arc::new(StillWorld::default())),
    };
    let simulated = || -> Result<Box<dyn Camera>, PluginError> {
        Ok(Box::new(SimulatedCamera::from_setup(&setup())?))
    };
    conformance::camera(&simulated).expect("conforms");
    let seen = simulated().expect("a camera").observe().expect("a look").cloud;
    assert!(seen.len() > 100, "the block shows {} points", seen.len());

    write_cloud(&folder.path().join("seen.ply"), &seen, Encoding::BinaryLittleEndian)
        .expect("written");
    let recorded = || -> Result<Box<dyn Camera>, PluginError> {
        Ok(Box::new(RecordedCamera::from_setup(&setup())?))
    };
    conformance::camera(&recorded).expect("conforms");
}
