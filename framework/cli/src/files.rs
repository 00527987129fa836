//! Checking any file the user may name: the runtime's own kinds, and objects, clouds and
//! weights besides.

use crate::objects;
use seeone_core::Diagnostic;
use seeone_core::formats::ply;
use seeone_nn::Card;
use seeone_runtime::files::{self, KnownMethods};
use std::fs;
use std::path::Path;

/// Everything that is wrong with a file; nothing when it is sound.
pub fn check(path: &Path, known: &KnownMethods) -> Vec<Diagnostic> {
    let extension = path.extension().and_then(|e| e.to_str()).unwrap_or_default();
    match extension {
        "ply" => ply::read_cloud(path).err().into_iter().collect(),
        "safetensors" => weights(path).err().into_iter().collect(),
        _ if is_object(path) => objects::read(path).err().into_iter().collect(),
        _ => files::check(path, known),
    }
}

/// A fault for each of `names`, which the file at `path` names, that is no object and no set.
pub fn unknown_objects(path: &Path, names: &[&str]) -> Vec<Diagnostic> {
    let text = fs::read_to_string(path).unwrap_or_default();
    let placed = |name: &&str| {
        let at = text.find(&format!("\"{name}\"")).unwrap_or(0);
        objects::unknown(name).map(|fault| fault.at_offset(path, &text, at))
    };
    names.iter().filter_map(placed).collect()
}

/// Object files are told by their lists of vertices.
fn is_object(path: &Path) -> bool {
    fs::read_to_string(path)
        .is_ok_and(|text| text.lines().any(|line| line.trim_start().starts_with("vertices")))
}

/// Weights are, to the byte, what the card beside them says they are.
fn weights(path: &Path) -> Result<(), Diagnostic> {
    let fault = |cause: String| Diagnostic::new("W002", cause).in_file(path);
    let folder = path.parent().unwrap_or(Path::new("."));
    let name = path.file_name().and_then(|n| n.to_str()).unwrap_or_default();
    let card = Card::read(folder)?;
    let (entry, _) = card.entry(folder, name)?;
    let bytes = fs::read(path).map_err(|e| fault(format!("cannot be read: {e}")))?;
    if blake3::hash(&bytes).to_hex().as_str() != entry.blake3 {
        return Err(fault("the weights are not those that the card describes".into()));
    }
    Ok(())
}
