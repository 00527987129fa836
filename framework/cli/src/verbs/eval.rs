//! `eval`: many attempts, their rates and their reasons.

pub mod grasps;
mod many;
mod placed;

use crate::args::{EvalSkillArgs, Series};
use crate::disturbance::Disturbance;
use crate::kept::Kept;
use crate::oracle::Oracle;
use crate::rate::Rate;
use crate::workcell::{Attempt, Workcell};
use crate::{Ending, console, objects};
use anyhow::Result;
use many::many;
use placed::Placed;
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
    disturbance: Disturbance,
    oracles: Vec<Oracle>,
    grasped: Rate,
    grasped_at_first_try: Rate,
    #[serde(flatten)]
    placed: Placed,
    failures: BTreeMap<String, u64>,
    attempts: Vec<Outcome>,
}

/// Makes all attempts and prints the table.
///
/// # Errors
/// When something given is wrong; a run that fails is a row, not an error.
pub fn run(args: &EvalSkillArgs) -> Result<Ending> {
    let series = &args.series;
    let workcell =
        Workcell::open(&series.cell)?.disturbed(&series.disturbance).consulting(&series.oracles);
    let fingerprint = || workcell.fingerprint(&series.objects);
    let kept = args.keep.as_ref().map(|path| Kept::open(path, fingerprint()?)).transpose()?;
    let outcomes = many(series, |seed| {
        if let Some(outcome) = kept.as_ref().and_then(|kept| kept.outcome(seed)) {
            return Ok(outcome.clone());
        }
        let object = objects::for_attempt(&series.objects, seed)?;
        let cell = workcell.drop(&object, seed)?;
        let attempt = Attempt { seed, dry_run: false, recording: None };
        let finished = workcell.attempt(&cell, &object, attempt, Hooks::default())?;
        if let Some(kept) = &kept {
            kept.keep(&finished.outcome)?;
        }
        Ok(finished.outcome)
    })?;
    let report = report(series, &workcell, outcomes);
    if series.json {
        console::answer(&serde_json::to_string_pretty(&report)?)?;
    } else {
        table(&report)?;
    }
    Ok(Ending::Success)
}

fn report(series: &Series, workcell: &Workcell, attempts: Vec<Outcome>) -> Report {
    let measure = &workcell.skill.measure;
    let mut failures = BTreeMap::new();
    for outcome in attempts.iter().filter(|outcome| !Placed::counts(measure, outcome)) {
        let stage = outcome.failed_at.as_deref().unwrap_or("placed");
        *failures.entry(stage.to_owned()).or_insert(0) += 1;
    }
    Report {
        skill: workcell.skill.name.clone(),
        robot: workcell.robot_name.clone(),
        objects: series.objects.clone(),
        methods: workcell.methods.iter().map(|(k, name)| (k.name(), name.to_owned())).collect(),
        first_seed: series.first_seed,
        tries: series.cell.tries,
        disturbance: series.disturbance,
        oracles: series.oracles.clone(),
        grasped: Rate::of(attempts.iter().map(|o| o.grasped == Some(true))),
        grasped_at_first_try: Rate::of(attempts.iter().map(|o| o.grasped_at_first == Some(true))),
        placed: Placed::of(measure, &attempts),
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
    let taken = [
        ("grasped", report.grasped.text()),
        ("at the first try", report.grasped_at_first_try.text()),
    ];
    for (name, text) in taken.into_iter().chain(report.placed.rows()) {
        console::answer(&format!("  {name:<20} {text}"))?;
    }
    for (stage, count) in &report.failures {
        console::answer(&format!("  failed at {stage:<10} {count}"))?;
    }
    Ok(())
}
