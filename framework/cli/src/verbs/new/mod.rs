//! `new`: the beginnings of what a user makes.

pub mod plugin;
pub mod robot;
pub mod skill;

use anyhow::Result;
use seeone_core::Diagnostic;
use seeone_runtime::files::is_name;
use std::fs;
use std::path::Path;

/// Refuses a name that files, crates and the command line cannot all carry.
///
/// # Errors
/// `G001`.
pub fn check_name(name: &str) -> Result<(), Diagnostic> {
    if is_name(name) && !name.ends_with('-') {
        return Ok(());
    }
    let cause = format!("{name:?} is no name: lower-case letters, digits and hyphens");
    Err(Diagnostic::new("G001", cause).hint("for example: my-skill"))
}

/// Refuses to write over what is there.
///
/// # Errors
/// `G002` for the first of `paths` at which something is.
pub fn check_vacant(paths: &[&Path]) -> Result<(), Diagnostic> {
    match paths.iter().find(|path| path.exists()) {
        Some(there) => {
            let cause = "something is there already; nothing was changed";
            let fault = Diagnostic::new("G002", cause).in_file(there);
            Err(fault.hint("choose another name, or another folder"))
        }
        None => Ok(()),
    }
}

/// Writes files into a folder that is not there yet.
///
/// # Errors
/// `G002` when something is there already, `F003` when it cannot be written.
pub fn write_folder(folder: &Path, files: &[(&str, String)]) -> Result<()> {
    check_vacant(&[folder])?;
    for (name, text) in files {
        let path = folder.join(name);
        let told = |e: std::io::Error| {
            Diagnostic::new("F003", format!("cannot be written: {e}")).in_file(&path)
        };
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(told)?;
        }
        fs::write(&path, text).map_err(told)?;
    }
    Ok(())
}
