//! `eval reconstruction`: the canonical shape that the encoding knows, against the truth.

use crate::args::EvalReconstructionArgs;
use crate::shown::observation;
use crate::{Ending, console};
use anyhow::{Result, anyhow};
use seeone_core::frames::Frame;
use seeone_nse::Nse;
use seeone_nse::reconstruction::{
    CHAMFER_POINTS, Distances, LEAST_SLOPE, LEVEL, MOVER_POINTS, SIDE, evaluate,
};
use seeone_nst::NstPerception;
use std::ops::ControlFlow;
use std::path::Path;

/// Reconstructs and prints the table.
///
/// # Errors
/// When the set or the weights cannot be read.
pub fn run(args: &EvalReconstructionArgs) -> Result<Ending> {
    let data = args.data.clone().unwrap_or_else(|| Path::new("data").join(&args.objects));
    let nst = NstPerception::load(&args.perception)?;
    let nse = Nse::load(&args.encoding, &args.perception)?;
    let perceive = |frame: &Frame| nst.canonical(&observation(frame));
    let mut go_on = |_| ControlFlow::Continue(());
    let figures = evaluate(&nse, &data, args.frames as usize, &perceive, &mut go_on)?
        .ok_or_else(|| anyhow!("the evaluation was broken off"))?;
    if args.json {
        console::answer(&serde_json::to_string_pretty(&figures)?)?;
        return Ok(Ending::Success);
    }
    console::answer("| surface | Chamfer, mean | Chamfer, squared | earth mover's |")?;
    console::answer("|---|---|---|---|")?;
    for (name, d) in [
        ("told from one view", figures.told),
        ("of the true winding number", figures.exact),
        ("truth against truth", figures.floor),
    ] {
        let Distances { chamfer, chamfer_squared, earth_mover } = d;
        console::answer(&format!(
            "| {name} | {chamfer:.4} | {chamfer_squared:.5} | {earth_mover:.4} |"
        ))?;
    }
    console::answer(&format!(
        "\n{} frames at rest, {} without a surface; unit: the canonical cube's edge. Winding \
         number {LEVEL} on {SIDE}^3 nodes where its slope is {LEAST_SLOPE} or more; \
         {CHAMFER_POINTS} points by area, the {MOVER_POINTS} farthest of them.",
        figures.frames, figures.without_surface
    ))?;
    Ok(Ending::Success)
}
