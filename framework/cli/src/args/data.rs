//! `data`: a training set.

use clap::Args;
use std::num::{NonZeroUsize, ParseIntError};
use std::path::PathBuf;

/// `data`.
#[derive(Clone, Debug, Args)]
pub struct DataArgs {
    /// Folder to write; whole shards already there are kept.
    #[arg(long)]
    pub out: PathBuf,
    /// Seed of every draw.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// A set (`train`, `wide`, `paper-40`, `validation`, `unseen`, `beanie`), a name, or a file
    /// from `objects import`; may be repeated.
    #[arg(long, default_values = ["train", "wide"])]
    pub objects: Vec<String>,
    /// Frames in all, shared evenly by the objects.
    #[arg(long, default_value_t = FRAMES, value_parser = frames)]
    pub frames: NonZeroUsize,
    /// Views of each moment, 1 to 4.
    #[arg(long, default_value_t = VIEWS, value_parser = views)]
    pub views: NonZeroUsize,
    /// What was made, as JSON.
    #[arg(long)]
    pub json: bool,
}

/// Frames of a training set unless told otherwise.
const FRAMES: NonZeroUsize = NonZeroUsize::new(5600).expect("not zero");
/// Views of a moment unless told otherwise: more drops teach more than more views of one.
const VIEWS: NonZeroUsize = NonZeroUsize::new(2).expect("not zero");
/// Most views of a moment.
const MOST_VIEWS: usize = 4;

fn frames(text: &str) -> Result<NonZeroUsize, String> {
    let frames: usize = text.parse().map_err(|e: ParseIntError| e.to_string())?;
    NonZeroUsize::new(frames).ok_or_else(|| "a set of no frames teaches nothing".into())
}

fn views(text: &str) -> Result<NonZeroUsize, String> {
    let views: usize = text.parse().map_err(|e: ParseIntError| e.to_string())?;
    let some = NonZeroUsize::new(views).filter(|_| views <= MOST_VIEWS);
    some.ok_or_else(|| format!("not from 1 to {MOST_VIEWS}"))
}
