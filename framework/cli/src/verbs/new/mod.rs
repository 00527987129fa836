//! `new`: the beginnings of what a user makes.

pub mod plugin;

use anyhow::Result;
use seeone_core::Diagnostic;
use std::fs;
use std::path::Path;

/// Refuses a name that files, crates and the command line cannot all carry.
///
/// # Errors
/// `G001`.
pub fn check_name(name: &str) -> Result<(), Diagnostic> {
    let letter = |c: char| c.is_ascii_lowercase();
    let sound = name.starts_with(letter)
        && !name.ends_with('-')
        && name.chars().all(|c| letter(c) || c.is_ascii_digit() || c == '-');
    if sound {
        return Ok(());
    }
    let cause = format!("{name:?} is no name: lower-case letters, digits and hyphens");
    Err(Diagnostic::new("G001", cause).hint("for example: my-search"))
}

/// Writes files into a folder that is not there yet.
///
/// # Errors
/// `G002` when something is there already, `F003` when it cannot be written.
pub fn write_folder(folder: &Path, files: &[(&str, String)]) -> Result<()> {
    if folder.exists() {
        let cause = "something is there already; nothing was changed";
        return Err(Diagnostic::new("G002", cause).in_file(folder).hint("choose --out").into());
    }
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
