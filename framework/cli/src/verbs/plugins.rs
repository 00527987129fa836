//! `plugins`: what is built in, which libraries are trusted, and whether a library is sound.

use crate::{Ending, builtin, console};
use anyhow::{Context, Result};
use seeone_core::Diagnostic;
use seeone_plugin::Kind;
use seeone_plugin::abi::library::PluginId;
use seeone_plugin::abi::{Library, Manifest};
use serde_json::{Value, json};
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::mpsc::channel;
use std::thread;
use std::time::Duration;

/// How long a library may take to be loaded and read.
const PROBE_LIMIT: Duration = Duration::from_secs(30);

/// Lists the plugins by kind, the default first, and the libraries of `folders` with what is
/// trusted of them or why they are refused. Nothing is loaded.
///
/// # Errors
/// When a folder cannot be read, or standard output has gone.
pub fn list(folders: &[PathBuf], json: bool) -> Result<Ending> {
    let registry = builtin::registry();
    let mut libraries = Vec::new();
    for folder in folders {
        for library in libraries_in(folder)? {
            let found = Library::examine(&library);
            libraries.push((library, found));
        }
    }
    if json {
        let kinds = Kind::ALL
            .iter()
            .map(|kind| json!({ "kind": kind.name(), "plugins": registry.names(*kind) }));
        let found = libraries.iter().map(|(library, found)| row(library, found));
        let rows: Vec<Value> = kinds.chain(found).collect();
        console::answer(&serde_json::to_string_pretty(&rows)?)?;
        return Ok(Ending::Success);
    }
    for kind in Kind::ALL {
        console::answer(&format!("{:<11} {}", kind.name(), registry.names(kind).join(", ")))?;
    }
    for (library, found) in &libraries {
        let told = match found {
            Ok(manifest) => format!("trusted: {}", ids(&manifest.plugins)),
            Err(refused) => format!("refused: {} [{}]", refused.cause, refused.code),
        };
        console::answer(&format!("{}  {told}", library.display()))?;
    }
    Ok(Ending::Success)
}

/// A library as JSON.
fn row(library: &Path, found: &Result<Manifest, Diagnostic>) -> Value {
    let library = library.display().to_string();
    match found {
        Ok(manifest) => {
            let plugins = manifest.plugins.iter().map(
                |id| json!({ "kind": id.kind.name(), "name": id.name, "version": id.version }),
            );
            let plugins: Vec<Value> = plugins.collect();
            json!({ "library": library, "trusted": true, "plugins": plugins })
        }
        Err(refused) => json!({
            "library": library,
            "trusted": false,
            "code": refused.code,
            "reason": refused.cause,
        }),
    }
}

/// The dynamic libraries of a folder, by name.
fn libraries_in(folder: &Path) -> Result<Vec<PathBuf>> {
    let told = |e: std::io::Error| {
        Diagnostic::new("F003", format!("the folder cannot be read: {e}")).in_file(folder)
    };
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(told)? {
        let path = entry.map_err(told)?.path();
        if path.extension().is_some_and(|e| e == std::env::consts::DLL_EXTENSION) {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

fn ids(plugins: &[PluginId]) -> String {
    plugins.iter().map(PluginId::to_string).collect::<Vec<_>>().join(", ")
}

/// Tells what a library offers, as another process finds it, and whether it is trusted.
///
/// # Errors
/// `L013` when it ended the process that loaded it, `L014` when it did not come back.
pub fn check(library: &Path) -> Result<Ending> {
    let offered = match probed(library)? {
        Probed::Sound(offered) => offered,
        Probed::Faulty(told) => {
            console::tell(told.trim_end());
            return Ok(Ending::Failure);
        }
    };
    console::answer(offered.trim_end())?;
    console::answer(&match Library::examine(library) {
        Ok(_) => "trusted".to_owned(),
        Err(refused) => format!("not trusted: {} [{}]", refused.cause, refused.code),
    })?;
    Ok(Ending::Success)
}

/// What [`probe`] told in a process of its own.
enum Probed {
    /// What the library offers.
    Sound(String),
    /// Why it cannot be served.
    Faulty(String),
}

fn probed(library: &Path) -> Result<Probed> {
    let program = std::env::current_exe().context("the program's own path")?;
    let mut child = Command::new(program)
        .args(["plugins", "probe", "--"])
        .arg(library)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .context("a process for the library")?;
    let (mut answer, mut error) = (child.stdout.take(), child.stderr.take());
    let (over, ended) = channel();
    // Both are short: what waits in the second pipe does not hold the child up.
    thread::spawn(move || _ = over.send((text(answer.as_mut()), text(error.as_mut()))));
    let refuse = |code, cause: String| Diagnostic::new(code, cause).in_file(library);
    let Ok((answer, error)) = ended.recv_timeout(PROBE_LIMIT) else {
        child.kill().context("a process that does not come back")?;
        child.wait()?;
        let seconds = PROBE_LIMIT.as_secs();
        return Err(refuse("L014", format!("it was not loaded within {seconds} s")).into());
    };
    let status = child.wait()?;
    match status.code() {
        Some(0) => Ok(Probed::Sound(answer)),
        Some(2) => Ok(Probed::Faulty(error)),
        _ => Err(refuse("L013", format!("it ended the process that loaded it: {status}"))
            .hint("do not trust it")
            .into()),
    }
}

/// All that comes out of a pipe.
fn text(pipe: Option<&mut impl Read>) -> String {
    let mut bytes = Vec::new();
    // What came before a fault of the pipe is as good as anything.
    let _ = pipe.map(|pipe| pipe.read_to_end(&mut bytes));
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Loads a library unchecked and tells what it offers.
///
/// # Errors
/// When it is no library of plugins.
pub fn probe(library: &Path) -> Result<Ending> {
    for offer in Library::probe(library)? {
        let (major, minor) = offer.abi;
        console::answer(&format!("{}, ABI {major}.{minor}", offer.id))?;
    }
    Ok(Ending::Success)
}

/// Writes the manifest of a library, by which this very file is loaded from then on. It is
/// tried by another process first.
///
/// # Errors
/// When it is not there or no plugin.
pub fn trust(library: &Path) -> Result<Ending> {
    // What a library that can be loaded lacks is told by what follows.
    let (Probed::Sound(_) | Probed::Faulty(_)) = probed(library)?;
    let Manifest { plugins, size_bytes, blake3 } = Manifest::write_for(library)?;
    for plugin in plugins {
        console::tell(&format!("{plugin} is trusted: {size_bytes} bytes, BLAKE3 {blake3}"));
    }
    Ok(Ending::Success)
}
