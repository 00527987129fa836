//! `eval`: many attempts, their rates and their reasons.

use crate::args::EvalSkillArgs;
use crate::kept::Kept;
use crate::rate::Rate;
use crate::workcell::{Attempt, Workcell};
use crate::{Ending, console, objects};
use anyhow::Result;
use indicatif::{ProgressBar, ProgressStyle};
use rayon::prelude::*;
use seeone_runtime::run::{Hooks, Outcome};
use serde::Serialize;
use std::collections::BTreeMap;

/// What an evaluation found.
#[derive(Debug, Serialize)]
struct Report {
    skill: String,
    robot: String,
    objects: String,
    methods: BTreeMap<&'static str, String>,
    first_seed: u64,
    tries: u64,
    grasped: Rate,
    grasped_at_first_try: Rate,
    worn_within_005_d: Rate,
    worn_within_01_d: Rate,
    worn_within_02_d: Rate,
    worn_properly: Rate,
    mean_error_m_of_worn_within_02_d: Option<f64>,
    failures: BTreeMap<String, u64>,
    attempts: Vec<Outcome>,
}

/// A cap is worn properly when, besides its error, its tilt and yaw are below these.
const PROPER_TILT_DEG: f64 = 10.0;
const PROPER_YAW_DEG: f64 = 15.0;

/// Makes all attempts and prints the table.
///
/// # Errors
/// When something given is wrong; a run that fails is a row, not an error.
pub fn run(args: &EvalSkillArgs) -> Result<Ending> {
    let workcell = Workcell::open(&args.cell)?;
    let fingerprint = || workcell.fingerprint(&args.objects);
    let kept = args.keep.as_ref().map(|path| Kept::open(path, fingerprint()?)).transpose()?;
    let bar = ProgressBar::new(args.attempts).with_style(ProgressStyle::with_template(
        "eval {wide_bar} {pos}/{len} attempts, {eta} left",
    )?);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.jobs.max(1)).build()?;
    let seeds = args.first_seed..args.first_seed + args.attempts;
    let outcomes: Vec<Outcome> = pool.install(|| {
        seeds
            .into_par_iter()
            .map(|seed| {
                if let Some(outcome) = kept.as_ref().and_then(|kept| kept.outcome(seed)) {
                    bar.inc(1);
                    return Ok(outcome.clone());
                }
                let object = objects::for_attempt(&args.objects, seed)?;
                let cell = workcell.drop(&object, seed)?;
                let attempt = Attempt { seed, dry_run: false, recording: None };
                let finished = workcell.attempt(&cell, &object, attempt, Hooks::default())?;
                if let Some(kept) = &kept {
                    kept.keep(&finished.outcome)?;
                }
                bar.inc(1);
                Ok(finished.outcome)
            })
            .collect::<Result<_>>()
    })?;
    bar.finish_and_clear();
    let report = report(args, &workcell, outcomes);
    if args.json {
        console::answer(&serde_json::to_string_pretty(&report)?)?;
    } else {
        table(&report)?;
    }
    Ok(Ending::Success)
}

fn report(args: &EvalSkillArgs, workcell: &Workcell, attempts: Vec<Outcome>) -> Report {
    let worn = |outcome: &Outcome, tolerance_d: f64| {
        let near = outcome.error_d.is_some_and(|e| e < tolerance_d);
        outcome.grasped == Some(true) && outcome.failed_at.is_none() && near
    };
    let properly = |outcome: &Outcome| {
        worn(outcome, 0.1)
            && outcome.tilt_deg.is_some_and(|t| t < PROPER_TILT_DEG)
            && outcome.yaw_deg.is_some_and(|y| y.abs() < PROPER_YAW_DEG)
    };
    let errors: Vec<f64> =
        attempts.iter().filter(|o| worn(o, 0.2)).filter_map(|o| o.error_m).collect();
    let mean = (!errors.is_empty()).then(|| errors.iter().sum::<f64>() / errors.len() as f64);
    let mut failures = BTreeMap::new();
    for outcome in attempts.iter().filter(|o| !worn(o, 0.2)) {
        let stage = outcome.failed_at.as_deref().unwrap_or("placed");
        *failures.entry(stage.to_owned()).or_insert(0) += 1;
    }
    Report {
        skill: workcell.skill.name.clone(),
        robot: workcell.robot_name.clone(),
        objects: args.objects.clone(),
        methods: workcell.methods.iter().map(|(k, name)| (k.name(), name.to_owned())).collect(),
        first_seed: args.first_seed,
        tries: args.cell.tries,
        grasped: Rate::of(attempts.iter().map(|o| o.grasped == Some(true))),
        grasped_at_first_try: Rate::of(
            attempts.iter().map(|o| o.grasped == Some(true) && o.tries == 1),
        ),
        worn_within_005_d: Rate::of(attempts.iter().map(|o| worn(o, 0.05))),
        worn_within_01_d: Rate::of(attempts.iter().map(|o| worn(o, 0.1))),
        worn_within_02_d: Rate::of(attempts.iter().map(|o| worn(o, 0.2))),
        worn_properly: Rate::of(attempts.iter().map(properly)),
        mean_error_m_of_worn_within_02_d: mean,
        failures,
        attempts,
    }
}

fn table(report: &Report) -> Result<()> {
    for outcome in &report.attempts {
        console::tell(&format!(
            "  seed {:>4}  {:<20} grasped {:<5} {}",
            outcome.seed,
            outcome.object,
            outcome.grasped == Some(true),
            outcome.reason
        ));
    }
    console::answer(&format!("{} on {} ({})", report.skill, report.objects, report.robot))?;
    for (name, rate) in [
        ("grasped", &report.grasped),
        ("at the first try", &report.grasped_at_first_try),
        ("worn within 0.2 d", &report.worn_within_02_d),
        ("worn within 0.1 d", &report.worn_within_01_d),
        ("worn within 0.05 d", &report.worn_within_005_d),
        ("worn properly", &report.worn_properly),
    ] {
        console::answer(&format!("  {name:<20} {}", rate.text()))?;
    }
    if let Some(mean) = report.mean_error_m_of_worn_within_02_d {
        console::answer(&format!(
            "  mean error           {:.1} mm (worn within 0.2 d)",
            mean * 1e3
        ))?;
    }
    for (stage, count) in &report.failures {
        console::answer(&format!("  failed at {stage:<10} {count}"))?;
    }
    Ok(())
}
