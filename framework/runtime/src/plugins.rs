//! The plugins of one run, built.

use crate::files::{RobotFile, Scene};
use crate::methods::Methods;
use crate::registry::Registry;
use seeone_core::Diagnostic;
use seeone_core::robot::RobotModel;
use seeone_plugin::{
    Alignment, Camera, Encoding, Judge, Kind, Kinematics, Motion, Perception, Robot, Setup,
    Transfer, World,
};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// What the plugins of one cell are built from.
pub struct Cell<'a> {
    /// Tables of configuration by kind; a kind without one gets an empty table.
    pub config: &'a BTreeMap<Kind, toml::Table>,
    /// The folder against which plugins resolve the paths of their tables.
    pub root: &'a Path,
    /// The seed of the run.
    pub seed: u64,
    /// The robot.
    pub robot: &'a RobotModel,
    /// The simulated world, when there is one.
    pub world: Option<Arc<dyn World>>,
}

/// The configuration that the files hold: the robot file's tables, and the camera's from
/// the scene with those of the robot file over it.
pub fn configuration(scene: &Scene, robot: &RobotFile) -> BTreeMap<Kind, toml::Table> {
    let mut config = robot.config.clone();
    let mut camera = scene.camera_table();
    camera.extend(config.remove(&Kind::Camera).unwrap_or_default());
    config.insert(Kind::Camera, camera);
    config
}

/// One plugin of each kind, and whoever can tell how the cell really is.
pub struct Plugins {
    /// Looks.
    pub camera: Box<dyn Camera>,
    /// Perceives.
    pub perception: Box<dyn Perception>,
    /// Encodes.
    pub encoding: Box<dyn Encoding>,
    /// Aligns.
    pub alignment: Box<dyn Alignment>,
    /// Transfers.
    pub transfer: Box<dyn Transfer>,
    /// Solves for joints.
    pub kinematics: Box<dyn Kinematics>,
    /// Plans.
    pub motion: Box<dyn Motion>,
    /// Moves.
    pub robot: Box<dyn Robot>,
    /// Judges; a cell that nobody can judge has none.
    pub judge: Option<Box<dyn Judge>>,
}

impl Plugins {
    /// Builds the plugins that `methods` names.
    ///
    /// # Errors
    /// `M001` or `M002` for the first that cannot be built.
    pub fn build(
        registry: &Registry,
        methods: &Methods,
        cell: &Cell,
        judge: Option<Box<dyn Judge>>,
    ) -> Result<Self, Diagnostic> {
        let empty = toml::Table::new();
        let name = |kind| methods.name(kind);
        let setup = |kind| Setup {
            config: cell.config.get(&kind).unwrap_or(&empty),
            root: cell.root,
            seed: cell.seed,
            robot: Some(cell.robot),
            world: cell.world.clone(),
        };
        Ok(Self {
            camera: registry.camera.build(name(Kind::Camera), &setup(Kind::Camera))?,
            perception: registry
                .perception
                .build(name(Kind::Perception), &setup(Kind::Perception))?,
            encoding: registry.encoding.build(name(Kind::Encoding), &setup(Kind::Encoding))?,
            alignment: registry.alignment.build(name(Kind::Alignment), &setup(Kind::Alignment))?,
            transfer: registry.transfer.build(name(Kind::Transfer), &setup(Kind::Transfer))?,
            kinematics: registry
                .kinematics
                .build(name(Kind::Kinematics), &setup(Kind::Kinematics))?,
            motion: registry.motion.build(name(Kind::Motion), &setup(Kind::Motion))?,
            robot: registry.robot.build(name(Kind::Robot), &setup(Kind::Robot))?,
            judge,
        })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use crate::fakes::{FakeCell, registry, robot_file};
    use std::path::PathBuf;

    #[test]
    fn the_robot_files_table_goes_over_the_scenes_camera() {
        let cell = FakeCell::new();
        let mut robot = robot_file(PathBuf::new());
        let cloud = toml::toml! { cloud = "other.ply" };
        robot.config.insert(Kind::Camera, cloud);
        robot.config.insert(Kind::Motion, toml::toml! { speed = 0.25 });
        let config = configuration(&cell.scene, &robot);
        assert_eq!(config[&Kind::Camera]["cloud"].as_str(), Some("other.ply"));
        assert_eq!(config[&Kind::Camera]["intrinsics"]["width"].as_integer(), Some(64));
        assert_eq!(config[&Kind::Motion]["speed"].as_float(), Some(0.25));
    }

    #[test]
    fn a_plugin_that_cannot_be_built_is_named() {
        let fake = FakeCell::new();
        let assignment = fake.assignment();
        let config = BTreeMap::new();
        let robot = &assignment.robot();
        let cell = Cell { config: &config, root: Path::new("."), seed: 1, robot, world: None };
        let told = Plugins::build(&registry(), assignment.methods(), &cell, None).err().unwrap();
        assert!(told.to_string().starts_with("error[M002]: camera plugin \"fake\""), "{told}");
    }
}
