//! `ik`: poses in, joint positions out.

use super::LibraryArgs;
use clap::{Args, ValueEnum};
use seeone_plugin::Kind;
use seeone_runtime::methods::parse_override;
use std::path::PathBuf;

/// The frame whose poses are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Frame {
    /// The flange, the URDF link `tool0`.
    Tool0,
    /// The tool link of the robot file.
    Tcp,
}

/// `ik`.
#[derive(Clone, Debug, Args)]
pub struct IkArgs {
    /// The robot file.
    #[arg(long, default_value = "robots/ur5-ag95-sim.toml")]
    pub robot: PathBuf,
    /// The targets (JSON).
    #[arg(long, value_name = "FILE", required_unless_present = "path")]
    pub targets: Option<PathBuf>,
    /// The targets are paths, each to be followed on one branch of the arm; named here, or by
    /// `--targets`.
    #[arg(long, value_name = "FILE", num_args = 0..=1)]
    pub path: Option<Option<PathBuf>>,
    /// The file to write; left out, the answers go to standard output.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Start each target from the robot's home and not from the answer before it.
    #[arg(long)]
    pub from_home: bool,
    /// Which frame the poses are of.
    #[arg(long, value_enum, default_value_t = Frame::Tool0)]
    pub frame: Frame,
    /// With `--frame tcp`: how far the pads are apart, metres; they come forward as they close,
    /// and the tool with them.
    #[arg(long, value_name = "METRES", default_value_t = 0.0)]
    pub opening: f64,
    /// Keep away from what stands in this scene too, and not from the robot itself alone.
    #[arg(long, value_name = "FILE")]
    pub scene: Option<PathBuf>,
    /// Plugins from dynamic libraries.
    #[command(flatten)]
    pub libraries: LibraryArgs,
    /// Use another plugin, e.g. `kinematics=damped-least-squares`.
    #[arg(long = "method", value_name = "KIND=PLUGIN", value_parser = parse_override)]
    pub methods: Vec<(Kind, String)>,
    /// Seed of the solver's restarts.
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
}
