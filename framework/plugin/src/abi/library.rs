//! A dynamic library, checked, loaded and never unloaded.

use super::loaded_alignment::LoadedAlignment;
use super::manifest::Manifest;
use super::table::{
    ABI_MAJOR, ABI_MINOR, AlignmentTable, ENTRY, Entry, Header, MAGIC, Span, kind_code,
};
use crate::{Alignment, Kind, PluginError, Setup};
use seeone_core::Diagnostic;
use std::fs;
use std::path::Path;

/// No plugin is larger than this; a wrong path to a huge file is told at once.
const LARGEST_LIBRARY: u64 = 1 << 30;

/// A name or version longer than this is a fault.
const LONGEST_TEXT: usize = 256;

/// A library that was trusted, is unchanged since, and has a table that this host serves.
#[derive(Debug)]
pub struct Library {
    manifest: Manifest,
    table: &'static AlignmentTable,
}

impl Library {
    /// Checks the library against its manifest and then loads it.
    ///
    /// # Errors
    /// A diagnostic `L001` to `L011` that names the library: no or damaged manifest, other
    /// size, other hash, not loadable, without an entry, or with a table that this host
    /// cannot serve or that contradicts the manifest.
    pub fn open(path: &Path) -> Result<Self, Diagnostic> {
        let manifest = Manifest::read_for(path)?;
        manifest.verify(path, &read(path)?)?;
        let loaded = load(path)?;
        let same = loaded.name == manifest.name
            && loaded.kind == manifest.kind
            && loaded.version == manifest.version
            && loaded.abi == manifest.abi;
        if !same {
            let cause = format!(
                "the library says it is {} {} ({}), its manifest {} {} ({})",
                loaded.name,
                loaded.version,
                loaded.kind,
                manifest.name,
                manifest.version,
                manifest.kind
            );
            return Err(Diagnostic::new("L011", cause).in_file(path));
        }
        Ok(Self { manifest, table: loaded.table })
    }

    /// What is trusted about it.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// Builds its plugin of kind `alignment`, the one kind served this way so far.
    ///
    /// # Errors
    /// What the plugin refuses about its setup.
    pub fn alignment(&self, setup: &Setup) -> Result<Box<dyn Alignment>, PluginError> {
        Ok(Box::new(LoadedAlignment::new(self.table, setup)?))
    }
}

/// A table with what its header says.
pub(super) struct Loaded {
    pub table: &'static AlignmentTable,
    pub name: String,
    pub kind: Kind,
    pub version: String,
    pub abi: (u32, u32),
}

/// The bytes of a library.
pub(super) fn read(path: &Path) -> Result<Vec<u8>, Diagnostic> {
    let refuse = |cause: String| Diagnostic::new("L005", cause).in_file(path);
    let metadata = fs::metadata(path).map_err(|e| refuse(e.to_string()))?;
    if !metadata.is_file() || metadata.len() > LARGEST_LIBRARY {
        return Err(refuse("not a file of at most 1 GiB".into()));
    }
    fs::read(path).map_err(|e| refuse(e.to_string()))
}

/// Loads a library **unchecked** and reads its table.
pub(super) fn load(path: &Path) -> Result<Loaded, Diagnostic> {
    let refuse = |code, cause: String| Diagnostic::new(code, cause).in_file(path);
    // A name without a folder would be looked up on the system's search path instead.
    let whole = path.canonicalize().map_err(|e| refuse("L005", e.to_string()))?;
    // SAFETY: initialisers run; the user trusts these bytes, checked by the caller.
    let library = unsafe { libloading::Library::new(&whole) };
    let library = library.map_err(|e| refuse("L005", causes(&e)))?;
    // Never unloaded: threads, thread-locals and function pointers of it may live on.
    let library = Box::leak(Box::new(library));
    // SAFETY: a symbol of this name has this type by the ABI's definition.
    let entry = unsafe { library.get::<Entry>(ENTRY) };
    let entry = entry.map_err(|e| {
        refuse("L006", causes(&e)).hint("a plugin exports the function `seeone_plugin`")
    })?;
    // SAFETY: the entry takes nothing and returns a table or null.
    let header = unsafe { entry() };
    // SAFETY: the table outlives the process' use of it, as the library does.
    unsafe { table(header) }.map_err(|told| told.in_file(path))
}

/// The message of an error with those of its sources: `dlopen`'s own is the last.
fn causes(error: &dyn std::error::Error) -> String {
    let sources = std::iter::successors(Some(error), |e| e.source());
    sources.map(ToString::to_string).collect::<Vec<_>>().join(": ")
}

/// The table that begins with `header`.
///
/// # Safety
/// Null, or valid, unchanging and for good as far as the magic and the `size` in it say.
unsafe fn table(header: *const Header) -> Result<Loaded, Diagnostic> {
    if header.is_null() || !header.is_aligned() {
        return Err(Diagnostic::new("L007", "the library returned no table"));
    }
    // SAFETY: every table begins with the magic.
    if unsafe { (*header).magic } != MAGIC {
        return Err(Diagnostic::new("L007", "the table does not begin as a plugin's does"));
    }
    // SAFETY: after the magic comes the rest of the header, in every version.
    let header: &'static Header = unsafe { &*header };
    check(header)?;
    // SAFETY: the header names a kind whose table this is, and at least its size.
    let table = unsafe { &*std::ptr::from_ref(header).cast::<AlignmentTable>() };
    if table.create.is_none() || table.align.is_none() || table.release.is_none() {
        return Err(Diagnostic::new("L009", "a function of the table is missing"));
    }
    // SAFETY: spans of the table are as valid as the table.
    let (name, version) = unsafe { (text(header.name)?, text(header.version)?) };
    Ok(Loaded {
        table,
        name,
        kind: Kind::Alignment,
        version,
        abi: (header.abi_major, header.abi_minor),
    })
}

/// Refuses a header that this host cannot serve.
fn check(header: &Header) -> Result<(), Diagnostic> {
    let (major, minor) = (header.abi_major, header.abi_minor);
    if major != ABI_MAJOR {
        let cause =
            format!("the library has ABI {major}.{minor}, this host {ABI_MAJOR}.{ABI_MINOR}");
        return Err(Diagnostic::new("L008", cause)
            .hint("build it against the seeone-plugin of this version"));
    }
    if Some(header.kind) != kind_code(Kind::Alignment) {
        let cause = format!("the library has a plugin of the unknown kind {}", header.kind);
        return Err(Diagnostic::new("L010", cause).hint("libraries serve the kind alignment"));
    }
    let needed = size_of::<AlignmentTable>() as u64;
    if header.size < needed {
        let cause = format!("the table has {} bytes, its kind needs {needed}", header.size);
        return Err(Diagnostic::new("L009", cause));
    }
    Ok(())
}

/// A short text of a header.
///
/// # Safety
/// As [`Span::slice`].
unsafe fn text(span: Span<u8>) -> Result<String, Diagnostic> {
    let told = || Diagnostic::new("L009", "a name in the table is empty, too long or not UTF-8");
    if !(1..=LONGEST_TEXT).contains(&span.len) {
        return Err(told());
    }
    // SAFETY: the caller's promise.
    let bytes = unsafe { span.slice() }.ok_or_else(told)?;
    String::from_utf8(bytes.to_owned()).map_err(|_| told())
}

#[cfg(test)]
mod tests;
