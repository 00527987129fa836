//! `plugins`: what is built in, and which libraries are trusted.

use crate::{Ending, builtin, console};
use anyhow::Result;
use seeone_plugin::Kind;
use seeone_plugin::abi::Manifest;
use serde_json::json;
use std::path::Path;

/// Lists the plugins by kind, the default first.
///
/// # Errors
/// When standard output has gone.
pub fn list(json: bool) -> Result<Ending> {
    let registry = builtin::registry();
    if json {
        let rows: Vec<_> = Kind::ALL
            .iter()
            .map(|kind| json!({ "kind": kind.name(), "plugins": registry.names(*kind) }))
            .collect();
        console::answer(&serde_json::to_string_pretty(&rows)?)?;
    } else {
        for kind in Kind::ALL {
            console::answer(&format!("{:<11} {}", kind.name(), registry.names(kind).join(", ")))?;
        }
    }
    Ok(Ending::Success)
}

/// Writes the manifest of a library, by which this very file is loaded from then on.
///
/// # Errors
/// When it is not there or no plugin.
pub fn trust(library: &Path) -> Result<Ending> {
    let manifest = Manifest::write_for(library)?;
    console::tell(&format!(
        "{} \"{}\" {} is trusted: {} bytes, BLAKE3 {}",
        manifest.kind, manifest.name, manifest.version, manifest.size_bytes, manifest.blake3
    ));
    Ok(Ending::Success)
}
