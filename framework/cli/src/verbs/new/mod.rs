//! `new`: files to begin with, which pass `check` as they are.

pub mod robot;
pub mod skill;

use seeone_core::Diagnostic;
use seeone_runtime::files::is_name;
use std::path::Path;

/// Refuses a name that no file may have, and to write over what is there.
///
/// # Errors
/// `F005` for a name, `F004` for what is there already.
fn vacant(name: &str, paths: &[&Path]) -> Result<(), Diagnostic> {
    if !is_name(name) {
        let cause = format!("{name:?} is no name");
        return Err(Diagnostic::new("F005", cause)
            .hint("small letters, digits and hyphens, a letter first: my-skill"));
    }
    match paths.iter().find(|path| path.exists()) {
        Some(there) => Err(Diagnostic::new("F004", "is there already")
            .in_file(there)
            .hint("choose another name, or another folder with --folder")),
        None => Ok(()),
    }
}
