//! `new`: the beginnings of what a user makes.

pub mod robot;
pub mod skill;

use seeone_core::Diagnostic;
use seeone_runtime::files::is_name;
use std::path::Path;

/// Refuses a name that files and the command line cannot both carry.
///
/// # Errors
/// `G001`.
pub fn check_name(name: &str) -> Result<(), Diagnostic> {
    if is_name(name) {
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
            Err(fault.hint("choose another name, or another folder with --folder"))
        }
        None => Ok(()),
    }
}
