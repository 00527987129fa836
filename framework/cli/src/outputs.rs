//! Folders and files that a command writes where the user said.

use seeone_core::Diagnostic;
use seeone_core::frames::write_whole;
use std::fs;
use std::path::Path;

/// Makes a folder, and those above it, unless it is there.
///
/// # Errors
/// `F002` when it cannot be made.
pub fn make_folder(folder: &Path) -> Result<(), Diagnostic> {
    fs::create_dir_all(folder).map_err(|e| {
        Diagnostic::new("F002", format!("cannot make the folder: {e}"))
            .in_file(folder)
            .hint("name another with --out")
    })
}

/// Writes a file, in one step: what is there is whole.
///
/// # Errors
/// `F003` when it cannot be written.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), Diagnostic> {
    write_whole(path, bytes).map_err(|e| {
        Diagnostic::new("F003", format!("cannot write the file: {e}"))
            .in_file(path)
            .hint("name another place with --out")
    })
}
