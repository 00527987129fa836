//! From what the user calls an object to the object itself.

use crate::outputs::write_file;
use anyhow::Result;
use seeone_core::Diagnostic;
use seeone_sim::category::cap::{self, Set};
use seeone_sim::object::Object;
use seeone_sim::object_file::{self, ObjectFileFault};
use std::fs;
use std::path::Path;

/// The object of this name, or of this file.
///
/// # Errors
/// A diagnostic when there is neither, or the file is no object.
pub fn resolve(name_or_file: &str) -> Result<Object> {
    if let Some(object) = cap::named(name_or_file) {
        return Ok(object);
    }
    let path = Path::new(name_or_file);
    if path.exists() || path.extension().is_some() {
        return Ok(read(path)?);
    }
    Err(none(name_or_file).into())
}

/// The fault of a name that is neither an object's nor a set's.
pub fn unknown(name: &str) -> Option<Diagnostic> {
    let set = Set::ALL.into_iter().any(|set| set.name() == name);
    (!set && cap::named(name).is_none()).then(|| none(name))
}

fn none(name: &str) -> Diagnostic {
    let names: Vec<String> = Set::DISJOINT.into_iter().flat_map(cap::names).collect();
    let fault = Diagnostic::new("O001", format!("there is no object \"{name}\""));
    let near = fault.clone().suggest(name, names.iter().map(String::as_str));
    match near.hint {
        Some(hint) if hint.starts_with("did you mean") => fault.hint(hint),
        _ => {
            fault.hint("see `seeone objects list`, or name a file made by `seeone objects import`")
        }
    }
}

/// The names of a set, or the one name or file that is none.
pub fn names(set_or_object: &str) -> Vec<String> {
    Set::ALL
        .into_iter()
        .find(|set| set.name() == set_or_object)
        .map_or_else(|| vec![set_or_object.to_owned()], cap::names)
}

/// The object of an attempt: the named one, or the set's member whose turn it is.
///
/// # Errors
/// As [`resolve`].
pub fn for_attempt(set_or_object: &str, seed: u64) -> Result<Object> {
    let names = names(set_or_object);
    resolve(&names[(seed % names.len() as u64) as usize])
}

/// Reads an object file.
///
/// # Errors
/// `O004` with its place when it cannot be read or is no object.
pub fn read(path: &Path) -> Result<Object, Diagnostic> {
    let unreadable = |e: std::io::Error| {
        Diagnostic::new("O004", e.to_string())
            .in_file(path)
            .hint("make one with `seeone objects import`")
    };
    let text = fs::read_to_string(path).map_err(unreadable)?;
    object_file::from_toml(&text).map_err(|fault| match &fault {
        ObjectFileFault::Syntax(error) => Diagnostic::new("O004", error.message()).at_offset(
            path,
            &text,
            error.span().map_or(0, |span| span.start),
        ),
        other => Diagnostic::new("O004", other.to_string()).in_file(path),
    })
}

/// Writes an object file, in one step.
///
/// # Errors
/// `F003` when it cannot be written, `O005` when TOML cannot hold it.
pub fn write(object: &Object, path: &Path) -> Result<(), Diagnostic> {
    let text = object_file::to_toml(object)
        .map_err(|e| Diagnostic::new("O005", e.to_string()).in_file(path))?;
    write_file(path, text.as_bytes())
}
