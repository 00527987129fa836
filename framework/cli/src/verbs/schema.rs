//! `schema`: what a kind of file may hold, for editors.

use crate::{Ending, console};
use anyhow::Result;
use seeone_runtime::files::{Family, schema};

/// Prints the JSON Schema of a kind of file.
///
/// # Errors
/// When standard output has gone.
pub fn run(kind: Family) -> Result<Ending> {
    console::answer(&serde_json::to_string_pretty(&schema(kind))?)?;
    Ok(Ending::Success)
}
