//! Which plugin does which part of a run.

use crate::files::{RobotFile, Scene, Skill};
use crate::registry::{Registry, unknown};
use seeone_core::Diagnostic;
use seeone_plugin::Kind;
use std::collections::BTreeMap;

/// A plugin's name for every kind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Methods(BTreeMap<Kind, String>);

impl Methods {
    /// Chooses: what `overrides` say, else what the files say (the robot file its robot,
    /// the scene its camera, the skill the rest), else the registry's default.
    ///
    /// # Errors
    /// `M001` for a plugin that there is not, `M003` for a kind without any plugin.
    pub fn resolve(
        skill: &Skill,
        scene: &Scene,
        robot: &RobotFile,
        overrides: &[(Kind, String)],
        registry: &Registry,
    ) -> Result<Self, Diagnostic> {
        let mut methods = BTreeMap::new();
        for kind in Kind::ALL {
            let known = registry.names(kind);
            let overriding = overrides.iter().rev().find(|(of, _)| *of == kind);
            let in_files = match kind {
                Kind::Robot => Some(&robot.plugin),
                Kind::Camera => scene.camera_plugin.as_ref(),
                _ => skill.methods.get(&kind),
            };
            let name = overriding
                .map(|(_, name)| name)
                .or(in_files)
                .or(known.first())
                .ok_or_else(|| Diagnostic::new("M003", format!("there is no {kind} plugin")))?;
            if !known.contains(name) {
                return Err(unknown(kind, name, known.iter().map(String::as_str)));
            }
            methods.insert(kind, name.clone());
        }
        Ok(Self(methods))
    }

    /// The plugin's name for a kind.
    pub fn name(&self, kind: Kind) -> &str {
        self.0.get(&kind).map_or("", String::as_str)
    }

    /// Kinds and names, in the order of [`Kind`].
    pub fn iter(&self) -> impl Iterator<Item = (Kind, &str)> {
        self.0.iter().map(|(kind, name)| (*kind, name.as_str()))
    }
}

/// One `KIND=NAME` of the command line.
///
/// # Errors
/// `M004` when it is not of that form or the kind is not known.
pub fn parse_override(text: &str) -> Result<(Kind, String), Diagnostic> {
    let Some((kind, name)) = text.split_once('=') else {
        let cause = format!("{text:?} is not of the form KIND=NAME");
        return Err(Diagnostic::new("M004", cause).hint("for example: transfer=unchanged"));
    };
    let kind: Kind = kind.parse().map_err(|()| {
        Diagnostic::new("M004", format!("there is no plugin kind {kind:?}"))
            .suggest(kind, Kind::ALL.map(Kind::name))
    })?;
    Ok((kind, name.to_owned()))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use crate::fakes::{FakeCell, registry, robot_file};
    use seeone_plugin::PluginError;
    use std::path::PathBuf;

    fn resolved(
        cell: &FakeCell,
        overrides: &[(Kind, String)],
        registry: &Registry,
    ) -> Result<Methods, Diagnostic> {
        let robot = robot_file(PathBuf::new());
        Methods::resolve(&cell.skill, &cell.scene, &robot, overrides, registry)
    }

    #[test]
    fn an_override_goes_before_the_file_and_the_file_before_the_default() {
        let mut registry = registry();
        for name in ["second", "third"] {
            registry.transfer.add(name, |_| Err(PluginError::Internal("not built".into())));
        }
        let mut cell = FakeCell::new();
        let name = |cell: &FakeCell, overrides: &[(Kind, String)]| {
            resolved(cell, overrides, &registry).unwrap().name(Kind::Transfer).to_owned()
        };
        assert_eq!(name(&cell, &[]), "fake");
        cell.skill.methods.insert(Kind::Transfer, "second".into());
        assert_eq!(name(&cell, &[]), "second");
        let overrides =
            [parse_override("transfer=second").unwrap(), parse_override("transfer=third").unwrap()];
        assert_eq!(name(&cell, &overrides), "third");
    }

    #[test]
    fn what_there_is_not_is_told() {
        let cell = FakeCell::new();
        let told = |overrides: &[(Kind, String)], registry: &Registry| {
            resolved(&cell, overrides, registry).unwrap_err().code
        };
        assert_eq!(told(&[(Kind::Motion, "none".into())], &registry()), "M001");
        // The robot file names its plugin; no kind before it has one.
        assert_eq!(told(&[], &Registry::new()), "M003");
        assert_eq!(parse_override("transfer").unwrap_err().code, "M004");
        let told = parse_override("transfr=snap").unwrap_err().to_string();
        assert!(told.contains("did you mean \"transfer\"?"), "{told}");
    }
}
