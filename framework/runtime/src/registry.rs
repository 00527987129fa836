//! Which plugins there are. The runtime names none of them: the binary registers those it
//! was linked with, and those that it loaded.

use crate::files::KnownMethods;
use seeone_core::Diagnostic;
use seeone_plugin::{
    Alignment, Camera, Encoding, Kind, Kinematics, Motion, Perception, PluginError, Robot, Setup,
    Transfer,
};
use std::fmt;

type Constructor<T> = Box<dyn Fn(&Setup) -> Result<Box<T>, PluginError> + Send + Sync>;

/// The plugins of one kind, in the order in which they were registered; the first is what
/// is meant when nobody names one.
pub struct Constructors<T: ?Sized> {
    kind: Kind,
    entries: Vec<(String, Constructor<T>)>,
}

impl<T: ?Sized> Constructors<T> {
    fn new(kind: Kind) -> Self {
        Self { kind, entries: Vec::new() }
    }

    /// Registers a plugin. One registered under the same name before is replaced, so that
    /// a loaded plugin may stand in for a linked one.
    pub fn add(
        &mut self,
        name: &str,
        constructor: impl Fn(&Setup) -> Result<Box<T>, PluginError> + Send + Sync + 'static,
    ) {
        match self.entries.iter_mut().find(|(known, _)| known == name) {
            Some(entry) => entry.1 = Box::new(constructor),
            None => self.entries.push((name.to_owned(), Box::new(constructor))),
        }
    }

    /// The names, the default first.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(|(name, _)| name.as_str())
    }

    /// Builds the plugin of this name.
    ///
    /// # Errors
    /// `M001` when there is none, with those there are; `M002` when it cannot be built.
    pub fn build(&self, name: &str, setup: &Setup) -> Result<Box<T>, Diagnostic> {
        let Some((_, constructor)) = self.entries.iter().find(|(known, _)| known == name) else {
            return Err(unknown(self.kind, name, self.names()));
        };
        constructor(setup).map_err(|fault| {
            Diagnostic::new("M002", format!("{} plugin \"{name}\": {fault}", self.kind))
        })
    }
}

impl<T: ?Sized> fmt::Debug for Constructors<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.names()).finish()
    }
}

/// The diagnostic for a plugin that there is not.
pub(crate) fn unknown<'a>(
    kind: Kind,
    name: &str,
    known: impl Iterator<Item = &'a str>,
) -> Diagnostic {
    Diagnostic::new("M001", format!("there is no {kind} plugin \"{name}\"")).suggest(name, known)
}

/// Every plugin there is, by kind.
#[derive(Debug)]
pub struct Registry {
    /// Depth cameras.
    pub camera: Constructors<dyn Camera>,
    /// Cloud -> canonical cloud.
    pub perception: Constructors<dyn Perception>,
    /// Canonical cloud -> field.
    pub encoding: Constructors<dyn Encoding>,
    /// Correspondences -> similarity.
    pub alignment: Constructors<dyn Alignment>,
    /// Demonstrated -> new canonical gripper poses.
    pub transfer: Constructors<dyn Transfer>,
    /// Tool pose -> joints.
    pub kinematics: Constructors<dyn Kinematics>,
    /// Key poses -> program.
    pub motion: Constructors<dyn Motion>,
    /// Program -> moved robot.
    pub robot: Constructors<dyn Robot>,
}

impl Registry {
    /// A registry without plugins.
    pub fn new() -> Self {
        Self {
            camera: Constructors::new(Kind::Camera),
            perception: Constructors::new(Kind::Perception),
            encoding: Constructors::new(Kind::Encoding),
            alignment: Constructors::new(Kind::Alignment),
            transfer: Constructors::new(Kind::Transfer),
            kinematics: Constructors::new(Kind::Kinematics),
            motion: Constructors::new(Kind::Motion),
            robot: Constructors::new(Kind::Robot),
        }
    }

    /// The names of the plugins of a kind, the default first.
    pub fn names(&self, kind: Kind) -> Vec<String> {
        let owned = str::to_owned;
        match kind {
            Kind::Camera => self.camera.names().map(owned).collect(),
            Kind::Perception => self.perception.names().map(owned).collect(),
            Kind::Encoding => self.encoding.names().map(owned).collect(),
            Kind::Alignment => self.alignment.names().map(owned).collect(),
            Kind::Transfer => self.transfer.names().map(owned).collect(),
            Kind::Kinematics => self.kinematics.names().map(owned).collect(),
            Kind::Motion => self.motion.names().map(owned).collect(),
            Kind::Robot => self.robot.names().map(owned).collect(),
        }
    }

    /// What files may name.
    pub fn known(&self) -> KnownMethods {
        Kind::ALL.into_iter().map(|kind| (kind, self.names(kind))).collect()
    }
}

impl Default for Registry {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use seeone_plugin::{AlignmentOutcome, Correspondences};
    use std::path::Path;

    struct Refusing;

    impl Alignment for Refusing {
        fn align(&self, _: &Correspondences) -> Result<AlignmentOutcome, PluginError> {
            Err(PluginError::Input("no".into()))
        }
    }

    #[test]
    fn builds_by_name_and_tells_what_there_is() {
        let mut registry = Registry::new();
        registry.alignment.add("procrustes", |_| Ok(Box::new(Refusing)));
        registry
            .alignment
            .add("broken", |_| Err(PluginError::Configuration("unknown field `a`".into())));
        let setup = Setup {
            config: &toml::Table::new(),
            root: Path::new("."),
            seed: 1,
            robot: None,
            world: None,
        };
        assert!(registry.alignment.build("procrustes", &setup).is_ok());
        let told = |name| registry.alignment.build(name, &setup).err().unwrap().to_string();
        assert_eq!(
            told("procrust"),
            "error[M001]: there is no alignment plugin \"procrust\"\n\n\
             hint: did you mean \"procrustes\"?"
        );
        assert_eq!(
            told("broken"),
            "error[M002]: alignment plugin \"broken\": configuration: unknown field `a`"
        );
        assert_eq!(registry.names(Kind::Alignment), ["procrustes", "broken"]);
        registry.alignment.add("broken", |_| Ok(Box::new(Refusing)));
        assert!(registry.alignment.build("broken", &setup).is_ok());
    }
}
