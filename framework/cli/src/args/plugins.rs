//! `plugins`: what is built in and what libraries offer.

use clap::Subcommand;
use std::path::PathBuf;

/// `plugins ...`.
#[derive(Debug, Subcommand)]
pub enum PluginsAction {
    /// What is built in, by kind; and which libraries of a folder are trusted, or why not.
    List {
        /// Folders to look for libraries in.
        folders: Vec<PathBuf>,
        /// As a JSON array.
        #[arg(long)]
        json: bool,
    },
    /// Try a dynamic library, trusted or not: what it offers, or why it cannot be served.
    ///
    /// It is loaded by another process, so that a library that ends its process is told like
    /// any other fault.
    Check {
        /// The library.
        library: PathBuf,
    },
    /// Loads a library unchecked, for `check` alone.
    #[command(hide = true)]
    Probe {
        /// The library.
        library: PathBuf,
    },
    /// Write the manifest of a dynamic library: from then on this very file is loaded.
    Trust {
        /// The library.
        library: PathBuf,
    },
}
