//! `objects`: what the category has.

use clap::{Args, Subcommand};
use std::path::PathBuf;

/// `objects ...`.
#[derive(Debug, Subcommand)]
pub enum ObjectsAction {
    /// The generated objects with template and sets, a line each.
    List {
        /// As a JSON array, with measures.
        #[arg(long)]
        json: bool,
    },
    /// Turn a mesh into an object of the category.
    Import(ImportArgs),
    /// Draw an object.
    Show {
        /// A name from `objects list`, or a file from `objects import`.
        object: String,
        /// The PNG file to write.
        #[arg(long, default_value = "out/object.png")]
        out: PathBuf,
    },
    /// Draw contact sheets: all objects, worn, dropped, and seen by the depth camera.
    Sheet {
        /// Seed of the drops and of the camera's noise.
        #[arg(long, default_value_t = 1)]
        seed: u64,
        /// The folder for caps.png, canonical.png, drops.png and depth.png.
        #[arg(long, default_value = "out")]
        out: PathBuf,
    },
}

/// `objects import`.
#[derive(Clone, Debug, Args)]
pub struct ImportArgs {
    /// The mesh: OBJ.
    pub mesh: PathBuf,
    /// The mesh's axis that points up when the cap is worn: +x, -x, +y, -y, +z or -z.
    #[arg(long, allow_hyphen_values = true)]
    pub up: String,
    /// The mesh's axis along which the visor points; found when left out.
    #[arg(long, allow_hyphen_values = true)]
    pub front: Option<String>,
    /// Circumference of the head it fits, metres: gives the scale.
    #[arg(long, value_name = "METRES")]
    pub head_circumference: f64,
    /// The object file to write (TOML).
    #[arg(long)]
    pub out: PathBuf,
}
