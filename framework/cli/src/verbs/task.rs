//! `run` of a task: its steps told as they begin and end, and at the end as a tree.

use crate::args::RunArgs;
use crate::outputs::make_folder;
use crate::site::{Site, TaskCell};
use crate::{Ending, console, interrupt, objects};
use anyhow::Result;
use seeone_runtime::files::SkillUse;
use seeone_runtime::task::{State, StepOutcome, TaskEvent, TaskHooks, TaskOutcome, run_task};
use serde::Serialize;
use std::rc::Rc;
use std::time::Instant;

/// Columns for names, while it is not known how long they are, and for each step that another lies
/// in.
const WIDTH: usize = 24;
const INDENT: usize = 2;

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
    let (clock, cancel) = (Instant::now(), interrupt::on_ctrl_c()?);
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
        cancel: cancel.clone(),
    };
    let outcome = run_task(task, &mut prepare, plugins, Box::new(cell), hooks)?;
    console::tell("");
    tree(&outcome.tree, 0, width(&outcome.tree, 0));
    summarise(&outcome);
    if args.json {
        let report = Report { outcome: &outcome, robot, scene: &site.scene.name, seed };
        console::answer(&serde_json::to_string_pretty(&report)?)?;
    }
    Ok(if cancel.is_ordered() { Ending::Interrupted } else { ending(&outcome, args.dry_run) })
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
    let over = !matches!(event.state, State::Underway | State::Skipped);
    let seconds = over.then_some(event.seconds);
    let reason = event.reason.as_deref();
    line(WIDTH, event.depth, mark(event.state), &event.name, seconds, reason);
}

/// A step, its runs where it has several, and the steps that lie in it.
fn tree(step: &StepOutcome, depth: usize, width: usize) {
    let seconds = (step.state != State::Skipped).then_some(step.seconds);
    line(width, depth, mark(step.state), &titled(step), seconds, step.reason.as_deref());
    if let [_, _, ..] = step.runs[..] {
        for (index, run) in step.runs.iter().enumerate() {
            let mark =
                if run.failed_at.is_none() && run.as_shown != Some(false) { "ok" } else { "FAIL" };
            line(width, depth + 1, mark, &format!("try {}", index + 1), None, Some(&run.reason));
        }
    }
    step.steps.iter().for_each(|step| tree(step, depth + 1, width));
}

/// A step's name, with the object that was laid before the robot for it.
fn titled(step: &StepOutcome) -> String {
    match &step.object {
        Some(object) if !step.name.ends_with(object) => format!("{} ({object})", step.name),
        _ => step.name.clone(),
    }
}

/// How wide the names of a tree are, with their indents.
fn width(step: &StepOutcome, depth: usize) -> usize {
    let below = step.steps.iter().map(|step| width(step, depth + 1)).max().unwrap_or(0);
    below.max(titled(step).len() + INDENT * depth).max(WIDTH)
}

fn mark(state: State) -> &'static str {
    match state {
        State::Waiting | State::Underway => "..",
        State::Done => "ok",
        State::Failed => "FAIL",
        State::Skipped => "--",
    }
}

fn line(
    width: usize,
    depth: usize,
    mark: &str,
    name: &str,
    seconds: Option<f64>,
    reason: Option<&str>,
) {
    let name = " ".repeat(INDENT * depth) + name;
    let seconds = seconds.map_or_else(|| " ".repeat(9), |seconds| format!("{seconds:7.2} s"));
    let told = format!("  {mark:<4} {name:<width$} {seconds}  {}", reason.unwrap_or_default());
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
