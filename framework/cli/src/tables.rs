//! The tables of a robot file that plugins read: each plugin checks its own, so it is asked.

use seeone_core::Diagnostic;
use seeone_core::robot::RobotModel;
use seeone_plugin::{Kind, Setup};
use seeone_runtime::Registry;
use seeone_runtime::files::{RobotFile, Scene, locate};
use std::path::Path;

/// A fault for each table that no plugin of its kind takes.
pub fn refused(
    file: &RobotFile,
    robot: &RobotModel,
    scene: Option<&Scene>,
    registry: &Registry,
) -> Vec<Diagnostic> {
    let tables = file.config.iter().filter_map(|(kind, table)| {
        let around = match (kind, scene) {
            // The camera's table lies over the scene's.
            (Kind::Camera, None) => return None,
            (Kind::Camera, Some(scene)) => scene.camera_table(),
            _ => toml::Table::new(),
        };
        let mut whole = around.clone();
        whole.extend(table.clone());
        let why = |name: &String| {
            let fault = told(registry, *kind, name, &whole, robot)?;
            // What it says without the table as well is not the table's fault: that a cell is
            // not simulated, that there are no weights.
            (told(registry, *kind, name, &around, robot).as_ref() != Some(&fault)).then_some(fault)
        };
        let names = registry.names(*kind);
        let mut refusals = names.iter().map(why).collect::<Option<Vec<_>>>()?;
        let chosen = names.iter().position(|name| *kind == Kind::Robot && *name == file.plugin);
        Some(placed(&file.path, *kind, refusals.swap_remove(chosen.unwrap_or(0))))
    });
    tables.collect()
}

/// Why a plugin cannot be built from a table, where there is no simulated world; none when it can.
fn told(
    registry: &Registry,
    kind: Kind,
    name: &str,
    config: &toml::Table,
    robot: &RobotModel,
) -> Option<String> {
    let setup = Setup { config, root: Path::new("."), seed: 0, robot: Some(robot), world: None };
    let built = match kind {
        Kind::Camera => registry.camera.build(name, &setup).err(),
        Kind::Perception => registry.perception.build(name, &setup).err(),
        Kind::Encoding => registry.encoding.build(name, &setup).err(),
        Kind::Alignment => registry.alignment.build(name, &setup).err(),
        Kind::Transfer => registry.transfer.build(name, &setup).err(),
        Kind::Kinematics => registry.kinematics.build(name, &setup).err(),
        Kind::Motion => registry.motion.build(name, &setup).err(),
        Kind::Robot => registry.robot.build(name, &setup).err(),
    };
    built.map(|fault| fault.cause)
}

/// The fault at the key that it names, or else at the table.
fn placed(file: &Path, kind: Kind, cause: String) -> Diagnostic {
    // What serde writes of keys: unknown field `a`, expected one of `b`, `c`.
    let quoted: Vec<&str> = cause.split('`').skip(1).step_by(2).collect();
    let word =
        |word: &str| word.trim_matches(|c: char| !c.is_alphanumeric() && c != '_').to_owned();
    let mentioned = cause.split_whitespace().map(word);
    let table = locate(file, &["config", kind.name()]);
    let keys = quoted.first().map(|key| (*key).to_owned()).into_iter().chain(mentioned);
    let at = keys
        .map(|key| locate(file, &["config", kind.name(), &key]))
        .find(|at| *at != table && *at != (1, 1))
        .unwrap_or(table);
    let fault = |cause: String| Diagnostic::new("B030", cause).at_line(file, at.0, at.1);
    match quoted[..] {
        [wrong, ref known @ ..] if cause.contains("unknown field") => {
            let cause = format!("no {kind} plugin has the key \"{wrong}\"");
            fault(cause).suggest(wrong, known.iter().copied())
        }
        _ => fault(cause),
    }
}
