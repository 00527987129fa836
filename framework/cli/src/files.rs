//! Checking any file the user may name: the runtime's own kinds, and objects, clouds, weights
//! and manifests besides.

use crate::fits::{Reach, misfits};
use crate::{objects, tables};
use seeone_core::Diagnostic;
use seeone_core::formats::ply;
use seeone_nn::Card;
use seeone_plugin::abi::Manifest;
use seeone_runtime::Registry;
use seeone_runtime::files::{self, Family, KnownMethods, RobotFile, Scene, Skill, Task};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// What files are checked against.
pub struct Against {
    /// Every plugin there is.
    pub registry: Registry,
    /// The robot whose reach skills are checked against, if any.
    pub reach: Option<Reach>,
    /// The scene whose frames skills are checked against, if any.
    pub scene: Option<Scene>,
}

impl Against {
    /// Everything that is wrong with a file; nothing when it is sound.
    pub fn check(&self, path: &Path) -> Vec<Diagnostic> {
        let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
        match extension {
            "ply" => ply::read_cloud(path).err().into_iter().collect(),
            "safetensors" => weights(path).err().into_iter().collect(),
            "so" | "dylib" | "dll" => library(path).err().into_iter().collect(),
            _ if is_manifest(path) => library(&path.with_extension("")).err().into_iter().collect(),
            _ if is_object(path) => objects::read(path).err().into_iter().collect(),
            _ => {
                let known = self.registry.known();
                let faults = files::check(path, &known);
                if faults.is_empty() { self.beside_others(path, &known) } else { faults }
            }
        }
    }

    /// What is wrong with a file that is sound by itself.
    fn beside_others(&self, path: &Path, known: &KnownMethods) -> Vec<Diagnostic> {
        let found = || match files::family_of(path)? {
            Family::Skill => {
                let skill = Skill::read(path, known)?;
                Ok(self.misfits(path, &skill, &BTreeMap::new()))
            }
            Family::Task => {
                let task = Task::read(path, known)?;
                let mut faults = unknown_objects(path, &task.objects());
                for used in task.uses() {
                    // A skill that is used twice is told of once.
                    let misfits = self.misfits(&used.path, &used.skill, &used.targets);
                    let new: Vec<_> = misfits.into_iter().filter(|m| !faults.contains(m)).collect();
                    faults.extend(new);
                }
                Ok(faults)
            }
            Family::Scene => {
                let scene = Scene::read(path, known)?;
                Ok(unknown_objects(path, &scene.objects()))
            }
            Family::Robot => {
                let file = RobotFile::read(path, known)?;
                let robot = file.model().map_err(|fault| vec![fault])?;
                Ok(tables::refused(&file, &robot, self.scene.as_ref(), &self.registry))
            }
        };
        found().unwrap_or_else(|faults: Vec<Diagnostic>| faults)
    }

    fn misfits(
        &self,
        path: &Path,
        skill: &Skill,
        targets: &BTreeMap<String, String>,
    ) -> Vec<Diagnostic> {
        misfits(path, skill, targets, self.reach.as_ref(), self.scene.as_ref())
    }
}

/// A library is, to the byte, what its manifest trusts; it is not loaded.
fn library(path: &Path) -> Result<(), Diagnostic> {
    let manifest = Manifest::read_for(path)?;
    let bytes = fs::read(path)
        .map_err(|e| Diagnostic::new("L005", format!("cannot be read: {e}")).in_file(path))?;
    manifest.verify(path, &bytes)
}

/// A manifest is named after its library: `libx.so.toml`.
fn is_manifest(path: &Path) -> bool {
    let library = path.file_stem().map(Path::new).and_then(Path::extension);
    path.extension().is_some_and(|e| e == "toml")
        && library.is_some_and(|e| ["so", "dylib", "dll"].iter().any(|known| e == *known))
}

/// A fault for each of `names`, which the file at `path` names, that is no object and no set.
pub fn unknown_objects(path: &Path, names: &[&str]) -> Vec<Diagnostic> {
    let text = fs::read_to_string(path).unwrap_or_default();
    let placed = |name: &&str| {
        let at = text.find(&format!("\"{name}\"")).unwrap_or(0);
        objects::unknown(name).map(|fault| fault.at_offset(path, &text, at))
    };
    names.iter().filter_map(placed).collect()
}

/// Object files are told by their lists of vertices.
fn is_object(path: &Path) -> bool {
    fs::read_to_string(path)
        .is_ok_and(|text| text.lines().any(|line| line.trim_start().starts_with("vertices")))
}

/// Weights are, to the byte, what the card beside them says they are.
fn weights(path: &Path) -> Result<(), Diagnostic> {
    let fault = |cause: String| Diagnostic::new("W002", cause).in_file(path);
    let folder = path.parent().unwrap_or(Path::new("."));
    let name = path.file_name().and_then(|n| n.to_str()).unwrap_or_default();
    let card = Card::read(folder)?;
    let (entry, _) = card.entry(folder, name)?;
    let bytes = fs::read(path).map_err(|e| fault(format!("cannot be read: {e}")))?;
    if blake3::hash(&bytes).to_hex().as_str() != entry.blake3 {
        return Err(fault("the weights are not those that the card describes".into()));
    }
    Ok(())
}
