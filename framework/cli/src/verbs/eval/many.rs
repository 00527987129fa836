//! Many attempts side by side.

use crate::args::Series;
use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;

/// What `each` makes of every seed of the series, in their order; a bar tells how far it is.
///
/// # Errors
/// The first that `each` has.
pub fn many<T: Send>(series: &Series, each: impl Fn(u64) -> Result<T> + Sync) -> Result<Vec<T>> {
    let bar = ProgressBar::new(series.attempts).with_style(ProgressStyle::with_template(
        "eval {wide_bar} {pos}/{len} attempts, {eta} left",
    )?);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(series.jobs.max(1)).build()?;
    let told = |seed| each(seed).inspect(|_| bar.inc(1));
    let made = pool.install(|| series.seeds().into_par_iter().map(told).collect::<Result<_>>())?;
    bar.finish_and_clear();
    Ok(made)
}
