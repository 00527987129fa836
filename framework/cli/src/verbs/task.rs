//! `run` of a task: its steps told as they begin and end, and at the end as a tree.

use crate::args::RunArgs;
use crate::outputs::make_folder;
use crate::site::{Site, TaskCell};
use crate::{Ending, console, objects};
use anyhow::Result;
use seeone_runtime::files::SkillUse;
use seeone_runtime::task::{State, StepOutcome, TaskEvent, TaskHooks, TaskOutcome, run_task};
use serde::Serialize;
use std::rc::Rc;
use std::time::Instant;

/// What `--json` prints.
#[derive(Serialize)]
struct Report<'a> {
    #[serde(flatten)]
    outcome: &'a TaskOutcome,
    robot: &'a str,
    scene: &'a str,
    seed: u64,
}

/// Carries the task out.
///
/// # Errors
/// When something given is wrong, or a file cannot be written.
pub fn run(args: &RunArgs) -> Result<Ending> {
    let clock = Instant::now();
    let site = Rc::new(Site::open(&args.cell)?);
    let object = match &args.object {
        Some(name) => objects::resolve(name)?,
        None => objects::for_attempt(&site.scene.object, args.seed)?,
    };
    make_folder(&args.out)?;
    let (task, robot, seed) = (&site.task, &site.robot_file.name, args.seed);
    let name = object.name().to_owned();
    console::tell(&format!("{} with {name} on {robot}, seed {seed}", task.name));
    let recording = args.out.join(format!("{}-{name}-seed{seed}.mcap", task.name));
    let mut prepare = |used: &SkillUse| -> Result<_> {
        let mut assignment = site.assignment(used)?;
        assignment.object.clone_from(&name);
        (assignment.seed, assignment.dry_run) = (seed, args.dry_run);
        assignment.recording = Some(recording.clone());
        Ok(assignment)
    };
    let (cell, plugins) = TaskCell::new(Rc::clone(&site), object, seed)?;
    let hooks = TaskHooks {
        clock: Box::new(move || clock.elapsed().as_secs_f64()),
        progress: Box::new(told),
    };
    let outcome = run_task(task, &mut prepare, plugins, Box::new(cell), hooks)?;
    console::tell("");
    tree(&outcome.tree, 0);
    summarise(&outcome);
    if args.json {
        let report = Report { outcome: &outcome, robot, scene: &site.scene.name, seed };
        console::answer(&serde_json::to_string_pretty(&report)?)?;
    }
    Ok(ending(&outcome, args.dry_run))
}

/// A dry run succeeds when every step was planned.
fn ending(outcome: &TaskOutcome, dry_run: bool) -> Ending {
    match outcome.success {
        Some(true) => Ending::Success,
        None if dry_run => Ending::Success,
        _ => Ending::Failure,
    }
}

fn told(event: &TaskEvent) {
    match event.state {
        State::Underway => line(event.depth, "..", &event.name, None, None),
        state => line(
            event.depth,
            mark(state),
            &event.name,
            (state != State::Skipped).then_some(event.seconds),
            event.reason.as_deref(),
        ),
    }
}

/// A step, its runs, and the steps that lie in it.
fn tree(step: &StepOutcome, depth: usize) {
    let seconds = (step.state != State::Skipped).then_some(step.seconds);
    line(depth, mark(step.state), &step.name, seconds, step.reason.as_deref());
    if let [_, _, ..] = step.runs[..] {
        for (index, run) in step.runs.iter().enumerate() {
            let mark = if run.failed_at.is_none() { "ok" } else { "FAIL" };
            line(depth + 1, mark, &format!("try {}", index + 1), None, Some(&run.reason));
        }
    }
    step.steps.iter().for_each(|step| tree(step, depth + 1));
}

fn mark(state: State) -> &'static str {
    match state {
        State::Waiting | State::Underway => "..",
        State::Done => "ok",
        State::Failed => "FAIL",
        State::Skipped => "--",
    }
}

fn line(depth: usize, mark: &str, name: &str, seconds: Option<f64>, reason: Option<&str>) {
    let indent = "  ".repeat(depth);
    let seconds = seconds.map_or_else(|| " ".repeat(9), |seconds| format!("{seconds:7.2} s"));
    let told = format!("  {mark:<4} {:<22} {seconds}  {}", indent + name, reason.unwrap_or(""));
    console::tell(told.trim_end());
}

fn summarise(outcome: &TaskOutcome) {
    let verdict = match outcome.success {
        Some(true) => "SUCCESS",
        Some(false) => "FAILURE",
        None => "NO VERDICT",
    };
    console::tell(&format!("{verdict}: {}", outcome.reason));
    recordings(&outcome.tree);
}

fn recordings(step: &StepOutcome) {
    for path in step.runs.iter().filter_map(|run| run.recording.as_ref()) {
        console::tell(&format!("  recording  {}", path.display()));
    }
    step.steps.iter().for_each(recordings);
}
