//! `new plugin`: a crate outside the workspace that builds, passes its kind's conformance suite,
//! and can be loaded.

use super::{check_name, write_folder};
use crate::args::NewPluginArgs;
use crate::{Ending, console};
use anyhow::Result;
use seeone_core::Diagnostic;
use seeone_plugin::Kind;
use std::fs;
use std::path::{Path, PathBuf};

/// The name of the plugin in the templates, and that of its type.
const PLACEHOLDERS: [&str; 2] = ["my-plugin", "MyPlugin"];

/// Writes the crate.
///
/// # Errors
/// `G001` to `G003`, or when it cannot be written.
pub fn run(args: &NewPluginArgs) -> Result<Ending> {
    let NewPluginArgs { name, kind, .. } = args;
    check_name(name)?;
    let framework = Framework::find(&args.framework)?;
    let folder = args.out.clone().unwrap_or_else(|| name.into());
    let mut files = vec![
        ("Cargo.toml", framework.manifest(name, *kind)),
        (".gitignore", "/target\n".to_owned()),
        ("src/lib.rs", named(template(*kind), name)),
    ];
    // So that it is built of the very versions that the host is built of.
    if let Ok(lock) = fs::read_to_string(framework.root.join("Cargo.lock")) {
        files.push(("Cargo.lock", lock));
    }
    write_folder(&folder, &files)?;
    let (at, library) = (folder.display(), library(&folder, name));
    let library = library.display();
    console::tell(&format!(
        "{at} is a {kind} plugin. Next:\n\
         \x20 cargo test --release --manifest-path {at}/Cargo.toml\n\
         \x20 cargo build --release --manifest-path {at}/Cargo.toml\n\
         \x20 seeone plugins trust {library}\n\
         \x20 seeone run skills/cap-wearing.toml --plugin {library} --method {kind}={name}"
    ));
    Ok(Ending::Success)
}

/// The plugin that a new one of this kind begins as.
fn template(kind: Kind) -> &'static str {
    match kind {
        Kind::Camera => include_str!("../../../templates/plugin/camera.rs"),
        Kind::Perception => include_str!("../../../templates/plugin/perception.rs"),
        Kind::Encoding => include_str!("../../../templates/plugin/encoding.rs"),
        Kind::Alignment => include_str!("../../../templates/plugin/alignment.rs"),
        Kind::Transfer => include_str!("../../../templates/plugin/transfer.rs"),
        Kind::Kinematics => include_str!("../../../templates/plugin/kinematics.rs"),
        Kind::Motion => include_str!("../../../templates/plugin/motion.rs"),
        Kind::Robot => include_str!("../../../templates/plugin/robot.rs"),
    }
}

/// A template under another name: `my-search`, and `MySearch` for its type.
fn named(template: &str, name: &str) -> String {
    let capital = |word: &str| {
        let (first, rest) = word.split_at_checked(1).unwrap_or((word, ""));
        first.to_ascii_uppercase() + rest
    };
    let type_name: String = name.split('-').map(capital).collect();
    template.replace(PLACEHOLDERS[0], name).replace(PLACEHOLDERS[1], &type_name)
}

/// Where cargo leaves the library.
fn library(folder: &Path, name: &str) -> PathBuf {
    let (prefix, suffix) = (std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    folder.join("target/release").join(format!("{prefix}{}{suffix}", name.replace('-', "_")))
}

/// The framework's sources, against which a plugin is built.
struct Framework {
    root: PathBuf,
    workspace: toml::Table,
}

impl Framework {
    /// # Errors
    /// `G003` when they do not lie there.
    fn find(root: &Path) -> Result<Self, Diagnostic> {
        let told = |cause: String| {
            Diagnostic::new("G003", format!("the framework's sources do not lie here: {cause}"))
                .in_file(root)
                .hint("name their folder with --framework")
        };
        let root = root.canonicalize().map_err(|e| told(e.to_string()))?;
        if !root.join("framework/plugin/Cargo.toml").exists() {
            return Err(told("there is no framework/plugin/Cargo.toml".into()));
        }
        let text = fs::read_to_string(root.join("Cargo.toml")).map_err(|e| told(e.to_string()))?;
        let workspace = text.parse().map_err(|e: toml::de::Error| told(e.to_string()))?;
        Ok(Self { root, workspace })
    }

    /// What the workspace depends on under this name.
    fn dependency(&self, name: &str) -> toml::Value {
        let known = self.workspace.get("workspace").and_then(|w| w.get("dependencies"));
        known.and_then(|all| all.get(name)).cloned().unwrap_or_else(|| "*".into())
    }

    /// The manifest of a plugin's crate.
    fn manifest(&self, name: &str, kind: Kind) -> String {
        let local = |folder: &str| {
            let path = self.root.join("framework").join(folder).display().to_string();
            toml::Value::Table([("path".to_owned(), path.into())].into_iter().collect())
        };
        let dependencies: String = [
            ("seeone-core", local("core")),
            ("seeone-plugin", local("plugin")),
            ("nalgebra", self.dependency("nalgebra")),
            ("serde", self.dependency("serde")),
        ]
        .iter()
        .map(|(name, value)| format!("{name} = {value}\n"))
        .collect();
        format!(
            "[package]\nname = \"{name}\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\
             description = \"A {kind} plugin of seeone\"\npublish = false\n\n\
             [lib]\ncrate-type = [\"cdylib\", \"rlib\"]\n\n\
             [dependencies]\n{dependencies}\n\
             # A workspace of its own.\n[workspace]\n"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_told_from_what_is_none() {
        for name in ["a", "my-search", "nst2"] {
            check_name(name).expect("a name");
        }
        for name in ["", "My", "2d", "a_b", "-a", "a-", "ö", "a/b"] {
            assert_eq!(check_name(name).expect_err("no name").code, "G001");
        }
    }

    #[test]
    fn every_template_takes_the_plugin_s_name() {
        for kind in Kind::ALL {
            let text = named(template(kind), "my-search");
            assert!(text.contains("\"my-search\" => MySearch::"), "{kind}: {text}");
            assert!(PLACEHOLDERS.iter().all(|left| !text.contains(left)), "{kind}");
        }
    }
}
