//! What a task asks of the cell that it is carried out in.

use crate::methods::Methods;
use crate::plugins::{self, Plugins};
use crate::registry::Registry;
use seeone_core::Diagnostic;
use seeone_plugin::{Kind, Setup};

/// The cell around a task.
pub trait Cell {
    /// Lays an object, or one of a set, before the robot, and tells its name; `plugins` then see
    /// and judge it. The robot stays where it is.
    ///
    /// # Errors
    /// Why it cannot be laid there.
    fn present(&mut self, object: &str, plugins: &mut Plugins) -> Result<String, String>;

    /// Makes `plugins` those that `methods` names. Camera, robot and judge belong to the cell
    /// and stay.
    ///
    /// # Errors
    /// Why one of them cannot be built.
    fn equip(&mut self, methods: &Methods, plugins: &mut Plugins) -> Result<(), String>;
}

/// Builds those of `plugins` anew in which the methods `now` differ from those `before`. Camera
/// and robot are the cell's and stay.
///
/// # Errors
/// `M001` or `M002` for the first that cannot be built.
pub fn exchange(
    plugins: &mut Plugins,
    registry: &Registry,
    [before, now]: [&Methods; 2],
    cell: &plugins::Cell,
) -> Result<(), Diagnostic> {
    let empty = toml::Table::new();
    let changed = |kind| before.name(kind) != now.name(kind);
    let (kinds, name) = (Kind::ALL, |kind| now.name(kind));
    for kind in kinds.into_iter().filter(|kind| changed(*kind)) {
        let setup = Setup {
            config: cell.config.get(&kind).unwrap_or(&empty),
            root: cell.root,
            seed: cell.seed,
            robot: Some(cell.robot),
            world: cell.world.clone(),
        };
        match kind {
            Kind::Camera | Kind::Robot => {}
            Kind::Perception => {
                plugins.perception = registry.perception.build(name(kind), &setup)?
            }
            Kind::Encoding => plugins.encoding = registry.encoding.build(name(kind), &setup)?,
            Kind::Alignment => plugins.alignment = registry.alignment.build(name(kind), &setup)?,
            Kind::Transfer => plugins.transfer = registry.transfer.build(name(kind), &setup)?,
            Kind::Kinematics => {
                plugins.kinematics = registry.kinematics.build(name(kind), &setup)?
            }
            Kind::Motion => plugins.motion = registry.motion.build(name(kind), &setup)?,
        }
    }
    Ok(())
}
