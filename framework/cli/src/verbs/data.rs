//! `data`: a training set, objects dropped, seen and labelled.

use crate::args::DataArgs;
use crate::outputs::make_folder;
use crate::{Ending, console, objects};
use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};
use seeone_sim::dataset::{Plan, generate};

/// Views of every moment that is kept.
const VIEWS: usize = 2;

/// Makes the set.
///
/// # Errors
/// When an object is not there or cannot be worn, or the folder cannot be written.
pub fn run(args: &DataArgs) -> Result<Ending> {
    let objects = objects::names(&args.objects)
        .iter()
        .map(|name| objects::resolve(name))
        .collect::<Result<Vec<_>>>()?;
    make_folder(&args.out)?;
    let plan = Plan {
        objects,
        drops_per_object: args.drops,
        views: VIEWS,
        seed: args.seed,
        command: format!(
            "seeone data --objects {} --drops {} --seed {} --out {}",
            args.objects,
            args.drops,
            args.seed,
            args.out.display()
        ),
    };
    let bar = ProgressBar::new(plan.objects.len() as u64).with_style(ProgressStyle::with_template(
        "{msg} {wide_bar} {pos}/{len} objects, {eta} left",
    )?);
    bar.set_message("data");
    let summary = generate(&plan, &args.out, &|progress| bar.set_position(progress.done as u64))?;
    bar.finish_and_clear();
    console::tell(&format!(
        "{} frames ({} at rest) of {} objects in {}; {} objects were there already",
        summary.frames,
        summary.settled,
        plan.objects.len(),
        args.out.display(),
        summary.resumed
    ));
    Ok(Ending::Success)
}
