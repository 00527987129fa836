//! `check`: files, before anything moves.

use super::LibraryArgs;
use clap::Args;
use std::path::PathBuf;

/// `check`.
#[derive(Clone, Debug, Args)]
pub struct CheckArgs {
    /// The files.
    #[arg(required = true)]
    pub files: Vec<PathBuf>,
    /// Whether this robot reaches the poses of skills and tasks.
    #[arg(long, value_name = "FILE")]
    pub robot: Option<PathBuf>,
    /// Whether this scene has the frames of skills and tasks.
    #[arg(long, value_name = "FILE")]
    pub scene: Option<PathBuf>,
    /// Plugins from dynamic libraries: what files may then name, too.
    #[command(flatten)]
    pub libraries: LibraryArgs,
    /// As a JSON array of faults.
    #[arg(long)]
    pub json: bool,
}
