//! `run`: one attempt, told as it happens.

use crate::args::RunArgs;
use crate::outputs::{make_folder, write_file};
use crate::picture::RunPicture;
use crate::verbs::task;
use crate::workcell::{Attempt, Workcell};
use crate::{Ending, console, interrupt, motion_table, objects};
use anyhow::Result;
use seeone_runtime::files::{Family, family_of};
use seeone_runtime::run::{Finished, Hooks, Outcome, Planned, StageEvent};
use std::path::Path;
use std::time::Instant;

/// Makes the attempt.
///
/// # Errors
/// When something given is wrong, or a file cannot be written.
pub fn run(args: &RunArgs) -> Result<Ending> {
    if family_of(&args.cell.skill).is_ok_and(|family| family == Family::Task) {
        return task::run(args);
    }
    let (clock, cancel) = (Instant::now(), interrupt::on_ctrl_c()?);
    let workcell = Workcell::open(&args.cell)?;
    let object = match &args.object {
        Some(name) => objects::resolve(name)?,
        None => objects::for_attempt(&workcell.scene.object, args.seed)?,
    };
    make_folder(&args.out)?;
    console::tell(&format!(
        "{} with {} on {}, seed {}",
        workcell.skill.name,
        object.name(),
        workcell.robot_name,
        args.seed
    ));
    let cell = workcell.drop(&object, args.seed)?;
    told(&StageEvent {
        name: "drop".into(),
        ok: true,
        seconds: clock.elapsed().as_secs_f64(),
        reason: None,
    });

    let stem = format!("{}-{}-seed{}", workcell.skill.name, object.name(), args.seed);
    let attempt = Attempt {
        seed: args.seed,
        dry_run: args.dry_run,
        recording: Some(args.out.join(format!("{stem}.mcap"))),
    };
    let hooks = Hooks {
        clock: Box::new(move || clock.elapsed().as_secs_f64()),
        progress: Box::new(told),
        cancel: cancel.clone(),
    };
    let picture = RunPicture::before(&workcell, &cell)?;
    let finished = workcell.attempt(&cell, &object, attempt, hooks)?;
    let path = args.out.join(format!("{stem}.png"));
    picture.finish(&workcell, &cell, &finished, &path)?;
    if let Some(planned) = finished.left::<Planned>() {
        let table = motion_table::table(&workcell.robot, &planned.program);
        let path = path.with_extension("csv");
        write_file(&path, table.as_bytes())?;
        console::tell(&format!("  motion     {}", path.display()));
    }
    summarise(&finished, &path, clock.elapsed().as_secs_f64());
    if args.json {
        console::answer(&serde_json::to_string_pretty(&finished.outcome)?)?;
    }
    Ok(match cancel.is_ordered() {
        true => Ending::Interrupted,
        false => ending(&finished.outcome, args.dry_run),
    })
}

/// A dry run succeeds when a plan was found.
fn ending(outcome: &Outcome, dry_run: bool) -> Ending {
    let planned = || outcome.failed_at.is_none();
    match outcome.success {
        Some(true) => Ending::Success,
        None if dry_run && planned() => Ending::Success,
        _ => Ending::Failure,
    }
}

fn told(event: &StageEvent) {
    let mark = if event.ok { "ok  " } else { "FAIL" };
    let reason = event.reason.as_deref().map(|r| format!("  {r}")).unwrap_or_default();
    console::tell(&format!("  {mark} {:<12} {:7.2} s{reason}", event.name, event.seconds));
}

fn summarise(finished: &Finished, picture: &Path, seconds: f64) {
    let outcome = &finished.outcome;
    let verdict = match (outcome.success, outcome.grasped) {
        (Some(true), _) => "SUCCESS",
        (Some(false), Some(true)) => "FAILURE (grasped)",
        (Some(false), _) => "FAILURE (not grasped)",
        (None, _) => "NO VERDICT",
    };
    console::tell(&format!("{verdict}: {}", outcome.reason));
    if let (Some(error_m), Some(error_d)) = (outcome.error_m, outcome.error_d) {
        console::tell(&format!("  error      {:.1} mm = {error_d:.3} d", error_m * 1e3));
    }
    if let Some(recording) = &outcome.recording {
        console::tell(&format!("  recording  {}", recording.display()));
    }
    console::tell(&format!("  picture    {}", picture.display()));
    console::tell(&format!("  time       {seconds:.1} s"));
}
