//! `eval grasps`: where perception and transfer would take an object, against where the expert
//! of `teach` takes it, which knows its true shape.

use super::many::many;
use crate::args::{EvalGraspsArgs, Series};
use crate::rate::Rate;
use crate::verbs::teach;
use crate::workcell::{Attempt, Workcell};
use crate::{Ending, console, objects};
use anyhow::Result;
use nalgebra::{UnitQuaternion, Vector3};
use seeone_core::Pose;
use seeone_core::pose::difference;
use seeone_runtime::run::{Hooks, Planned, Transferred};
use serde::Serialize;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// A grasp that is off by more than this holds something else.
const NEAR_M: f64 = 0.02;
const NEAR_DEG: f64 = 20.0;

/// One grasp.
#[derive(Debug, Serialize)]
struct Told {
    seed: u64,
    object: String,
    /// How far it is off, if there is one.
    off: Option<Off>,
    /// Whether the robot has a way to carry it out.
    planned: bool,
    /// Why there is no grasp, or no way.
    reason: Option<String>,
}

#[derive(Clone, Copy, Debug, Serialize)]
struct Off {
    metres: f64,
    degrees: f64,
}

impl Off {
    /// Between tool poses: pads that are exchanged hold the same.
    fn between(told: &Pose, truth: &Pose) -> Self {
        let exchanged = told * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), PI);
        let (metres, turned) = difference(told, truth);
        let (_, other) = difference(&exchanged, truth);
        Self { metres, degrees: turned.min(other).to_degrees() }
    }

    fn is_near(&self) -> bool {
        self.metres < NEAR_M && self.degrees < NEAR_DEG
    }
}

#[derive(Debug, Serialize)]
struct Report {
    skill: String,
    objects: String,
    methods: BTreeMap<&'static str, String>,
    first_seed: u64,
    near: Rate,
    planned: Rate,
    /// Of the grasps that there are.
    median: Option<Off>,
    ninety_percent: Option<Off>,
    grasps: Vec<Told>,
}

/// Looks at every object once and prints the table.
///
/// # Errors
/// As the evaluation of a skill, and when the expert knows no way to take an object.
pub fn run(args: &EvalGraspsArgs) -> Result<Ending> {
    let series = &args.series;
    let workcell =
        Workcell::open(&series.cell)?.disturbed(&series.disturbance).consulting(&series.oracles);
    let grasps = many(series, |seed| {
        let object = objects::for_attempt(&series.objects, seed)?;
        let cell = workcell.drop(&object, seed)?;
        let (expert, now) = teach::grasp(&cell)?;
        let truth = expert.tool_on(now.vertices());
        let attempt = Attempt { seed, dry_run: true, recording: None };
        let finished = workcell.attempt(&cell, &object, attempt, Hooks::default())?;
        let best = finished.left::<Transferred>().and_then(|found| found.grasps.first());
        let planned = finished.left::<Planned>().is_some();
        Ok(Told {
            seed,
            object: object.name().to_owned(),
            off: best.map(|grasp| Off::between(&grasp.tool, &truth)),
            planned,
            reason: (!planned).then(|| finished.outcome.reason.clone()),
        })
    })?;
    let report = report(series, &workcell, grasps);
    if series.json {
        console::answer(&serde_json::to_string_pretty(&report)?)?;
    } else {
        table(&report)?;
    }
    Ok(Ending::Success)
}

fn report(series: &Series, workcell: &Workcell, grasps: Vec<Told>) -> Report {
    Report {
        skill: workcell.skill.name.clone(),
        objects: series.objects.clone(),
        methods: workcell.methods.iter().map(|(k, name)| (k.name(), name.to_owned())).collect(),
        first_seed: series.first_seed,
        near: Rate::of(grasps.iter().map(|told| told.off.is_some_and(|off| off.is_near()))),
        planned: Rate::of(grasps.iter().map(|told| told.planned)),
        median: quantile(&grasps, 0.5),
        ninety_percent: quantile(&grasps, 0.9),
        grasps,
    }
}

/// The quantile of metres and of degrees, each by itself; the nearest rank.
fn quantile(grasps: &[Told], share: f64) -> Option<Off> {
    let of = |figure: fn(Off) -> f64| {
        let mut all: Vec<f64> = grasps.iter().filter_map(|told| told.off.map(figure)).collect();
        all.sort_by(f64::total_cmp);
        let rank = (share * all.len() as f64).ceil() as usize;
        all.get(rank.saturating_sub(1)).copied()
    };
    Some(Off { metres: of(|off| off.metres)?, degrees: of(|off| off.degrees)? })
}

fn table(report: &Report) -> Result<()> {
    for told in &report.grasps {
        let off = told.off.map_or_else(|| "no grasp".to_owned(), text);
        let reason = told.reason.as_deref().unwrap_or("");
        console::tell(&format!("  seed {:>4}  {:<20} {off}  {reason}", told.seed, told.object));
    }
    console::answer(&format!("grasps of {} on {}", report.skill, report.objects))?;
    for (kind, method) in &report.methods {
        console::answer(&format!("  {kind:<12} {method}"))?;
    }
    let near = format!("within {:.0} mm and {NEAR_DEG} degrees", NEAR_M * 1e3);
    let quantile = |off: Option<Off>| off.map_or_else(|| "none".to_owned(), text);
    for (name, value) in [
        ("median", quantile(report.median)),
        ("90 %", quantile(report.ninety_percent)),
        (&near, report.near.text()),
        ("have a way", report.planned.text()),
    ] {
        console::answer(&format!("  {name:<28} {value}"))?;
    }
    Ok(())
}

fn text(off: Off) -> String {
    format!("{:>5.1} mm {:>5.1} degrees", off.metres * 1e3, off.degrees)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;

    fn told(off: Option<(f64, f64)>) -> Told {
        let off = off.map(|(metres, degrees)| Off { metres, degrees });
        Told { seed: 0, object: "cap".into(), off, planned: true, reason: None }
    }

    #[test]
    fn pads_exchanged_are_no_error_and_a_turn_about_another_axis_is() {
        let truth = Pose::new(Vector3::new(0.1, 0.2, 0.3), Vector3::new(0.3, -0.2, 0.1));
        let turned = |axis, degrees: f64| {
            truth * UnitQuaternion::from_axis_angle(&axis, degrees.to_radians())
        };
        assert!(Off::between(&turned(Vector3::z_axis(), 180.0), &truth).degrees < 1e-6);
        let off = Off::between(&turned(Vector3::x_axis(), 30.0), &truth);
        assert!((off.degrees - 30.0).abs() < 1e-6 && !off.is_near(), "{off:?}");
    }

    #[test]
    fn quantiles_are_ranks_of_what_there_is() {
        let all: Vec<Told> = (1..=10)
            .map(|i| told(Some((f64::from(i), f64::from(11 - i)))))
            .chain([told(None)])
            .collect();
        let median = quantile(&all, 0.5).unwrap();
        assert_eq!((median.metres, median.degrees), (5.0, 5.0));
        assert_eq!(quantile(&all, 0.9).unwrap().metres, 9.0);
        assert!(quantile(&all[10..], 0.5).is_none());
    }
}
