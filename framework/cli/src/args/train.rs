//! `train`: the networks.

use clap::{Args, ValueEnum};
use std::num::ParseFloatError;
use std::path::PathBuf;

/// What to train.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Network {
    /// Observation -> canonical.
    Nst,
    /// Canonical -> features anywhere.
    Nse,
    /// One after the other.
    All,
}

/// `train`.
#[derive(Clone, Debug, Args)]
pub struct TrainArgs {
    /// Which network.
    pub network: Network,
    /// The training set.
    #[arg(long, default_value = "data/train")]
    pub data: PathBuf,
    /// Seed of the initial weights, of the order of samples and of every augmentation.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Folder under which `nst` and `nse` put their weights and cards.
    #[arg(long, default_value = "weights")]
    pub out: PathBuf,
    /// Share of the full number of samples, for a trial: 1 trains fully.
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true, value_parser = share)]
    pub share: f64,
}

fn share(text: &str) -> Result<f64, String> {
    let share: f64 = text.parse().map_err(|e: ParseFloatError| e.to_string())?;
    // A comparison that NaN fails.
    if share > 0.0 && share <= 10.0 { Ok(share) } else { Err("not above 0 and up to 10".into()) }
}
