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
use seeone_plugin::Measure;
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
    #[serde(flatten)]
    all: Group,
    by_object: BTreeMap<String, Group>,
    failures: BTreeMap<String, u64>,
    /// How long each stage took the robot, on average over the times that it was carried out.
    stage_s: BTreeMap<String, f64>,
    attempts: Vec<Outcome>,
}

/// The rates of some attempts.
#[derive(Debug, Serialize)]
struct Group {
    grasped: Rate,
    grasped_at_first_try: Rate,
    #[serde(flatten)]
    placed: Placed,
}

impl Group {
    fn of(measure: &Measure, attempts: &[&Outcome]) -> Self {
        let rate = |ok: fn(&Outcome) -> bool| Rate::of(attempts.iter().map(|outcome| ok(outcome)));
        Self {
            grasped: rate(|outcome| outcome.grasped == Some(true)),
            grasped_at_first_try: rate(|outcome| outcome.grasped_at_first == Some(true)),
            placed: Placed::of(measure, attempts),
        }
    }

    fn rates(&self) -> Vec<(&'static str, &Rate)> {
        let taken = [("grasped", &self.grasped), ("at the first try", &self.grasped_at_first_try)];
        taken.into_iter().chain(self.placed.rates()).collect()
    }
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
    for failure in attempts.iter().filter_map(|outcome| Placed::failure(measure, outcome)) {
        *failures.entry(failure).or_insert(0) += 1;
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
        all: Group::of(measure, &attempts.iter().collect::<Vec<_>>()),
        by_object: by_object(measure, &attempts),
        failures,
        stage_s: stage_s(&attempts),
        attempts,
    }
}

fn by_object(measure: &Measure, attempts: &[Outcome]) -> BTreeMap<String, Group> {
    let mut groups: BTreeMap<&str, Vec<&Outcome>> = BTreeMap::new();
    for outcome in attempts {
        groups.entry(&outcome.object).or_default().push(outcome);
    }
    let group =
        |(object, own): (&str, Vec<&Outcome>)| (object.to_owned(), Group::of(measure, &own));
    groups.into_iter().map(group).collect()
}

fn stage_s(attempts: &[Outcome]) -> BTreeMap<String, f64> {
    let mut sums: BTreeMap<&str, (f64, f64)> = BTreeMap::new();
    // What thinks takes no time in an evaluation, whose bytes no clock may change.
    let done = attempts.iter().flat_map(|outcome| &outcome.stages).filter(|s| s.seconds > 0.0);
    for stage in done {
        let (sum, count) = sums.entry(&stage.name).or_default();
        (*sum, *count) = (*sum + stage.seconds, *count + 1.0);
    }
    sums.into_iter().map(|(name, (sum, count))| (name.to_owned(), sum / count)).collect()
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
    for (name, rate) in report.all.rates() {
        console::answer(&format!("  {name:<20} {}", rate.text()))?;
    }
    if let Some(mean_m) = report.all.placed.mean_error_m() {
        let mean_mm = mean_m * 1e3;
        console::answer(&format!("  {:<20} {mean_mm:.1} mm (worn within 0.2 d)", "mean error"))?;
    }
    for (object, group) in report.by_object.iter().filter(|_| report.by_object.len() > 1) {
        let rate = |(name, rate): (&str, &Rate)| format!("{name} {}", rate.short());
        let rates: Vec<String> = group.rates().into_iter().map(rate).collect();
        console::answer(&format!("  {object:<20} {}", rates.join(", ")))?;
    }
    for (stage, count) in &report.failures {
        console::answer(&format!("  failed: {stage:<12} {count}"))?;
    }
    for (stage, seconds) in &report.stage_s {
        console::answer(&format!("  {stage:<20} {seconds:.1} s of the robot's time"))?;
    }
    Ok(())
}
