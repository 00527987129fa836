//! `run`: a skill or a task, once.

use super::CellArgs;
use clap::Args;
use std::path::PathBuf;

/// `run`.
#[derive(Clone, Debug, Args)]
pub struct RunArgs {
    /// Skill, robot, scene, methods.
    #[command(flatten)]
    pub cell: CellArgs,
    /// The object: a name from `objects list`, or a file from `objects import`.
    #[arg(long, value_name = "NAME|FILE")]
    pub object: Option<String>,
    /// Seed of the drop, of the camera's noise and of every other draw.
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Plan, but do not move.
    #[arg(long)]
    pub dry_run: bool,
    /// Print the outcome as one JSON object on standard output.
    #[arg(long)]
    pub json: bool,
    /// Folder for the recording, the picture and the table of the planned motion.
    #[arg(long, default_value = "out")]
    pub out: PathBuf,
}
