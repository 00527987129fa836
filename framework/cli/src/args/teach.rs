//! `teach`: a demonstration recorded.

use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// `teach`.
#[derive(Clone, Debug, Args)]
pub struct TeachArgs {
    /// The skill file to write; its cloud goes into a folder of its name beside it.
    pub skill: PathBuf,
    /// What is shown.
    #[arg(long, value_enum, default_value_t = Shown::Wearing)]
    pub show: Shown,
    /// The object that is shown.
    #[arg(long, default_value = "cap-train-077")]
    pub object: String,
    /// Seed of the drop and of the camera's noise.
    #[arg(long, default_value_t = 4)]
    pub seed: u64,
    /// The robot that shows it.
    #[arg(long, default_value = "robots/ur5-ag95-sim.toml")]
    pub robot: PathBuf,
    /// The scene it is shown in.
    #[arg(long, default_value = "scenes/head.toml")]
    pub scene: PathBuf,
}

/// What the scripted expert can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Shown {
    /// Putting a cap on the scene's head.
    Wearing,
    /// Hanging a cap on the scene's hook.
    Hanging,
}
