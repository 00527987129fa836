//! `new`: what is begun from a template.

use clap::{Args, Subcommand};
use seeone_plugin::Kind;
use std::path::PathBuf;

/// `new ...`.
#[derive(Debug, Subcommand)]
pub enum NewAction {
    /// A plugin: a crate that builds a dynamic library and passes its own tests.
    Plugin(NewPluginArgs),
    /// A skill, begun from the demonstration of another.
    Skill(NewSkillArgs),
    /// A robot file for an arm that a URDF describes.
    Robot(NewRobotArgs),
}

/// `new plugin`.
#[derive(Clone, Debug, Args)]
pub struct NewPluginArgs {
    /// Its name, as it is chosen by `--method KIND=NAME`.
    pub name: String,
    /// What it does.
    #[arg(long, value_parser = kind)]
    pub kind: Kind,
    /// The folder to make; left out, one of its name.
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    /// Where this framework's sources lie.
    #[arg(long, value_name = "FOLDER", default_value = ".")]
    pub framework: PathBuf,
}

/// `new skill`.
#[derive(Clone, Debug, Args)]
pub struct NewSkillArgs {
    /// Its name: small letters, digits and hyphens.
    pub name: String,
    /// The folder to write into.
    #[arg(long, value_name = "FOLDER", default_value = "skills")]
    pub folder: PathBuf,
    /// The skill that it is begun from.
    #[arg(long, value_name = "FILE", default_value = "skills/cap-wearing.toml")]
    pub from: PathBuf,
}

/// `new robot`.
#[derive(Clone, Debug, Args)]
pub struct NewRobotArgs {
    /// Its name: small letters, digits and hyphens.
    pub name: String,
    /// The description of the arm with its gripper; copied into the folder unless it lies there.
    #[arg(long, value_name = "FILE")]
    pub urdf: PathBuf,
    /// The tool's link: z along the approach, y along the closing direction, between the pads.
    #[arg(long, value_name = "LINK", default_value = "tcp")]
    pub tool_link: String,
    /// The folder to write into.
    #[arg(long, value_name = "FOLDER", default_value = "robots")]
    pub folder: PathBuf,
}

fn kind(text: &str) -> Result<Kind, String> {
    let known = Kind::ALL.map(Kind::name).join(", ");
    text.parse().map_err(|()| format!("not one of {known}"))
}
