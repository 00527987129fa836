//! A dynamic library, checked, loaded and never unloaded.

use super::callee::Callee;
use super::instance::{Direct, Named};
use super::kinds::{Remote, WorldCallee, setup_message};
use super::manifest::Manifest;
use super::table::{ABI_MAJOR, ABI_MINOR, ENTRY, Entry, Header, MAGIC, Span, Table, kind_of};
use super::worker::Worker;
use crate::{Kind, PluginError, Setup};
use seeone_core::Diagnostic;
use std::fmt;
use std::fs;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// No plugin is larger than this; a wrong path to a huge file is told at once.
const LARGEST_LIBRARY: u64 = 1 << 30;

/// A name or version longer than this is a fault.
const LONGEST_TEXT: usize = 256;

/// A library that offers more plugins than this does not end its list.
const MOST_PLUGINS: usize = 64;

/// A plugin of a library, behind the trait of its kind.
pub type LoadedPlugin = Remote<Arc<dyn Callee>>;

/// A library that was trusted, is unchanged since, and has tables that this host serves.
#[derive(Debug)]
pub struct Library {
    manifest: Manifest,
    offers: Vec<Offer>,
}

impl Library {
    /// Checks the library against its manifest and then loads it.
    ///
    /// # Errors
    /// A diagnostic `L001` to `L012` that names the library: no or damaged manifest, other
    /// size, other hash, not loadable, without an entry, or with a table that this host
    /// cannot serve or that contradicts the manifest.
    pub fn open(path: &Path) -> Result<Self, Diagnostic> {
        let manifest = Self::examine(path)?;
        let offers = load(path)?;
        let told = |plugins: &[PluginId]| -> String {
            plugins.iter().map(PluginId::to_string).collect::<Vec<_>>().join(", ")
        };
        let offered: Vec<PluginId> = offers.iter().map(|offer| offer.id.clone()).collect();
        if offered != manifest.plugins {
            let cause = format!(
                "the library says it has {}, its manifest {}",
                told(&offered),
                told(&manifest.plugins)
            );
            return Err(Diagnostic::new("L011", cause).in_file(path));
        }
        Ok(Self { manifest, offers })
    }

    /// Compares the library with its manifest, and loads nothing.
    ///
    /// # Errors
    /// `L001` to `L005`, as [`Library::open`].
    pub fn examine(path: &Path) -> Result<Manifest, Diagnostic> {
        let manifest = Manifest::read_for(path)?;
        manifest.verify(path, &read(path)?)?;
        Ok(manifest)
    }

    /// Loads a library **unchecked** and tells what it offers. It may end the process: for a
    /// process that does nothing else.
    ///
    /// # Errors
    /// `L005` to `L012`, as [`Library::open`].
    pub fn probe(path: &Path) -> Result<Vec<Offer>, Diagnostic> {
        read(path)?;
        load(path)
    }

    /// What is trusted about it.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// Its plugins.
    pub fn offers(&self) -> &[Offer] {
        &self.offers
    }
}

/// What a plugin is called.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PluginId {
    /// Its name.
    pub name: String,
    /// Its kind.
    pub kind: Kind,
    /// Its version.
    pub version: String,
}

impl fmt::Display for PluginId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} \"{}\" {}", self.kind, self.name, self.version)
    }
}

/// A plugin that a library offers.
#[derive(Clone, Debug)]
pub struct Offer {
    /// What it is called.
    pub id: PluginId,
    /// Major and minor version of its ABI.
    pub abi: (u32, u32),
    table: &'static Table,
}

impl Offer {
    /// Builds the plugin, on a thread of its own. Whatever it is asked from then on, it is left
    /// alone for good when it gives no sign of life for `patience`: neither an answer nor a
    /// call of something that was lent to it. Without a patience it is called on the caller's
    /// own thread, which spares a few microseconds a call and never ends when the plugin does
    /// not.
    ///
    /// # Errors
    /// What the plugin refuses about its setup.
    pub fn build(
        &self,
        setup: &Setup,
        patience: Option<Duration>,
    ) -> Result<LoadedPlugin, PluginError> {
        let world = setup.world.clone();
        let world = world.map(|world| Box::new(WorldCallee(world)) as Box<dyn Callee>);
        let named = Named { kind: self.id.kind, name: self.id.name.clone() };
        let message = setup_message(setup)?;
        let callee: Arc<dyn Callee> = match patience {
            Some(patience) => Worker::start(self.table, named, message, world, patience)?,
            None => Arc::new(Direct::start(self.table, named, &message, world)?),
        };
        Ok(Remote::new(callee, setup.robot.cloned().map(Arc::new)))
    }
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

/// Loads a library **unchecked** and reads its tables.
pub(super) fn load(path: &Path) -> Result<Vec<Offer>, Diagnostic> {
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
    let entry: Entry = *entry;
    // SAFETY: the entry takes any index and returns a table or null; tables outlive the
    // process' use of them, as the library does.
    let tables = |index| unsafe { entry(index) };
    // SAFETY: as above.
    unsafe { offers(tables) }.map_err(|told| told.in_file(path))
}

/// The plugins of a library whose entry is `tables`.
///
/// # Safety
/// What `tables` returns must be as [`table`] demands.
unsafe fn offers(tables: impl Fn(u32) -> *const Header) -> Result<Vec<Offer>, Diagnostic> {
    let mut offers: Vec<Offer> = Vec::new();
    for index in 0.. {
        let header = tables(index);
        if header.is_null() {
            break;
        }
        // SAFETY: the caller's promise.
        let offer = unsafe { table(header) }?;
        let (kind, name) = (offer.id.kind, &offer.id.name);
        if offers.iter().any(|other| other.id.kind == kind && other.id.name == *name) {
            let cause = format!("the library has two {kind} plugins \"{name}\"");
            return Err(Diagnostic::new("L012", cause));
        }
        offers.push(offer);
        if offers.len() > MOST_PLUGINS {
            let cause = format!("the library's list of tables goes on after {MOST_PLUGINS}");
            return Err(Diagnostic::new("L007", cause));
        }
    }
    if offers.is_empty() {
        return Err(Diagnostic::new("L007", "the library returned no table"));
    }
    Ok(offers)
}

/// The message of an error with those of its sources: `dlopen`'s own is the last.
fn causes(error: &dyn std::error::Error) -> String {
    let sources = std::iter::successors(Some(error), |e| e.source());
    sources.map(ToString::to_string).collect::<Vec<_>>().join(": ")
}

/// The plugin whose table begins with `header`.
///
/// # Safety
/// Valid, unchanging and for good as far as the magic and the `size` in it say.
unsafe fn table(header: *const Header) -> Result<Offer, Diagnostic> {
    if !header.is_aligned() {
        return Err(Diagnostic::new("L007", "the library returned no table"));
    }
    // SAFETY: every table begins with the magic.
    if unsafe { (*header).magic } != MAGIC {
        return Err(Diagnostic::new("L007", "the table does not begin as a plugin's does"));
    }
    // SAFETY: after the magic comes the rest of the header, in every version.
    let header: &'static Header = unsafe { &*header };
    let kind = check(header)?;
    // SAFETY: the header says that the table has at least its size.
    let table = unsafe { &*std::ptr::from_ref(header).cast::<Table>() };
    for (name, missing) in [
        ("create", table.create.is_none()),
        ("call", table.call.is_none()),
        ("release", table.release.is_none()),
    ] {
        if missing {
            let cause = format!("the function \"{name}\" of the table is missing");
            return Err(Diagnostic::new("L009", cause));
        }
    }
    // SAFETY: spans of the table are as valid as the table.
    let (name, version) = unsafe { (text(header.name)?, text(header.version)?) };
    let id = PluginId { name, kind, version };
    Ok(Offer { id, abi: (header.abi_major, header.abi_minor), table })
}

/// Refuses a header that this host cannot serve.
fn check(header: &Header) -> Result<Kind, Diagnostic> {
    let (major, minor) = (header.abi_major, header.abi_minor);
    if major != ABI_MAJOR {
        let cause =
            format!("the library has ABI {major}.{minor}, this host {ABI_MAJOR}.{ABI_MINOR}");
        return Err(Diagnostic::new("L008", cause)
            .hint("build it against the seeone-plugin of this version"));
    }
    let Some(kind) = kind_of(header.kind) else {
        let cause = format!("the library has a plugin of the unknown kind {}", header.kind);
        return Err(Diagnostic::new("L010", cause));
    };
    let needed = size_of::<Table>() as u64;
    if header.size < needed {
        let cause = format!("the table has {} bytes, its kind needs {needed}", header.size);
        return Err(Diagnostic::new("L009", cause));
    }
    Ok(kind)
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
