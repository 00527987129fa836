//! `data`: a training set, objects dropped and held up, seen and labelled.

use crate::args::DataArgs;
use crate::outputs::make_folder;
use crate::{Ending, console, objects};
use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};
use seeone_sim::dataset::{Plan, Summary, generate};

/// Makes the set.
///
/// # Errors
/// When an object is not there, cannot be worn or is hardly ever seen, or when the folder
/// cannot be written or holds another plan's set.
pub fn run(args: &DataArgs) -> Result<Ending> {
    let names = args.objects.iter().flat_map(|given| objects::names(given));
    let objects = names.map(|name| objects::resolve(&name)).collect::<Result<Vec<_>>>()?;
    make_folder(&args.out)?;
    let plan = Plan {
        objects,
        frames: args.frames,
        views: args.views,
        seed: args.seed,
        command: format!(
            "seeone data{} --frames {} --views {} --seed {} --out {}",
            args.objects.iter().map(|given| format!(" --objects {given}")).collect::<String>(),
            args.frames,
            args.views,
            args.seed,
            args.out.display()
        ),
    };
    let bar = ProgressBar::new(plan.frames.get() as u64).with_style(ProgressStyle::with_template(
        "{msg} {wide_bar} {pos}/{len} frames, {eta} left",
    )?);
    bar.set_message("data");
    let summary = generate(&plan, &args.out, &|progress| bar.set_position(progress.done as u64))?;
    bar.finish_and_clear();
    if args.json {
        console::answer(&serde_json::to_string_pretty(&summary)?)?;
        return Ok(Ending::Success);
    }
    let Summary { objects, falling, resting, held, resumed } = summary;
    console::tell(&format!(
        "{} frames ({falling} falling, {resting} at rest, {held} held) of {objects} objects in {}; \
         {resumed} objects were there already",
        summary.frames(),
        args.out.display(),
    ));
    Ok(Ending::Success)
}
