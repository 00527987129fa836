//! `eval perception`: canonical coordinates against the truth, by what was to be seen.

use crate::args::EvalPerceptionArgs;
use crate::{Ending, console};
use anyhow::Result;
use seeone_core::Diagnostic;
use seeone_core::frames::{CanonicalObject, Moment, read_all};
use seeone_nst::evaluate::{CONFIDENCE_BINS, ConfidenceBin, FrameFigures, Group, LOST_DEG};
use seeone_nst::{Effort, Figures, Nst, evaluate, record};
use seeone_sim::category::cap;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Bounds of the visible share that are told apart.
const VISIBLE: [f64; 5] = [0.0, 0.25, 0.35, 0.45, 1.01];
/// Share of the frames that are called doubtful: those with the lowest confidence.
const DOUBTFUL: f64 = 0.05;

#[derive(Debug, Serialize)]
struct Report {
    data: PathBuf,
    weights: PathBuf,
    groups: Vec<(String, Group)>,
    confidence: Vec<ConfidenceBin>,
    lost_at_rest: usize,
    lost_at_rest_and_doubtful: usize,
}

/// Perceives every frame of the set and prints the table.
///
/// # Errors
/// When the set or the weights cannot be read.
pub fn run(args: &EvalPerceptionArgs) -> Result<Ending> {
    let data = args.data.clone().unwrap_or_else(|| Path::new("data").join(&args.objects));
    let (index, frames) = read_all(&data).map_err(|fault| made_by(fault, args, &data))?;
    let effort = if args.one_pass { Effort::OnePass } else { Effort::Full };
    let nst = Nst::load(&args.weights)?.with_effort(effort);
    let figures = evaluate(&nst, &index.objects, &frames);
    if args.record {
        record(&args.weights, &args.objects, &Figures::of(&figures))?;
    }
    let report = report(args, data, &index.objects, &figures);
    if args.json {
        console::answer(&serde_json::to_string_pretty(&report)?)?;
    } else {
        table(&report)?;
    }
    Ok(Ending::Success)
}

fn made_by(fault: Diagnostic, args: &EvalPerceptionArgs, data: &Path) -> Diagnostic {
    if data.join("index.json").exists() {
        return fault;
    }
    fault.hint(format!(
        "make it: seeone data --objects {} --frames 800 --out {}",
        args.objects,
        data.display()
    ))
}

fn report(
    args: &EvalPerceptionArgs,
    data: PathBuf,
    objects: &[CanonicalObject],
    figures: &[FrameFigures],
) -> Report {
    let at_rest = || figures.iter().filter(|f| f.moment == Moment::Resting);
    let template = |f: &FrameFigures| {
        cap::member(&objects[f.object].name).map_or("imported", |m| m.template.name())
    };
    let mut groups: Vec<(String, Group)> =
        [("at rest", Moment::Resting), ("falling", Moment::Falling), ("held", Moment::Held)]
            .map(|(name, moment)| {
                (name.to_owned(), Group::of(figures.iter().filter(|f| f.moment == moment)))
            })
            .into();
    groups.push(("all".into(), Group::of(figures.iter())));
    groups.extend(by(at_rest(), |f| format!("at rest, {}", template(f))));
    groups.extend(by(at_rest(), |f| format!("at rest, {}", objects[f.object].name)));
    for bounds in VISIBLE.windows(2) {
        let inside = |f: &&FrameFigures| (bounds[0]..bounds[1]).contains(&f.visible);
        let name = format!(
            "at rest, {:.0}-{:.0} % seen",
            100.0 * bounds[0],
            (100.0 * bounds[1]).min(100.0)
        );
        groups.push((name, Group::of(at_rest().filter(inside))));
    }
    let mut by_confidence: Vec<&FrameFigures> = at_rest().collect();
    by_confidence.sort_by(|a, b| a.confidence.total_cmp(&b.confidence));
    let doubtful = (DOUBTFUL * by_confidence.len() as f64).ceil() as usize;
    let lost = |frames: &[&FrameFigures]| frames.iter().filter(|f| f.turned_deg > LOST_DEG).count();
    Report {
        data,
        weights: args.weights.clone(),
        groups,
        confidence: confidence(figures),
        lost_at_rest: lost(&by_confidence),
        lost_at_rest_and_doubtful: lost(&by_confidence[..doubtful]),
    }
}

/// The frames in groups by name, in the order of the names.
fn by<'a>(
    frames: impl Iterator<Item = &'a FrameFigures>,
    name: impl Fn(&FrameFigures) -> String,
) -> Vec<(String, Group)> {
    let mut groups: BTreeMap<String, Vec<&FrameFigures>> = BTreeMap::new();
    frames.for_each(|f| groups.entry(name(f)).or_default().push(f));
    groups.into_iter().map(|(name, frames)| (name, Group::of(frames.iter().copied()))).collect()
}

/// The points of all frames at rest by their confidence.
fn confidence(figures: &[FrameFigures]) -> Vec<ConfidenceBin> {
    let mut bins = vec![ConfidenceBin::default(); CONFIDENCE_BINS];
    for frame in figures.iter().filter(|f| f.moment == Moment::Resting) {
        for (sum, bin) in bins.iter_mut().zip(&frame.bins) {
            sum.points += bin.points;
            sum.confidence += bin.confidence;
            sum.within_01_d += bin.within_01_d;
        }
    }
    bins
}

fn table(report: &Report) -> Result<()> {
    console::answer("| frames | number | within 0.04 d | within 0.1 d | mirrored | over 30 deg |")?;
    console::answer("|---|---|---|---|---|---|")?;
    for (name, group) in &report.groups {
        let percent = |share: f64| format!("{:.1} %", 100.0 * share);
        console::answer(&format!(
            "| {name} | {} | {} | {} | {} | {} |",
            group.frames,
            percent(group.within_004_d),
            percent(group.within_01_d),
            percent(group.mirrored),
            percent(group.over_30_degrees)
        ))?;
    }
    console::answer("\n| confidence, at rest | points | mean | within 0.1 d |")?;
    console::answer("|---|---|---|---|")?;
    for (tenth, bin) in report.confidence.iter().enumerate().filter(|(_, b)| b.points > 0) {
        let of = |sum: f64| sum / bin.points as f64;
        console::answer(&format!(
            "| {:.1}-{:.1} | {} | {:.3} | {:.3} |",
            0.1 * tenth as f64,
            0.1 * (tenth + 1) as f64,
            bin.points,
            of(bin.confidence),
            of(bin.within_01_d as f64)
        ))?;
    }
    console::answer(&format!(
        "\n{} frames at rest are over 30 deg off; {} of them are among the {:.0} % with the lowest \
         confidence",
        report.lost_at_rest,
        report.lost_at_rest_and_doubtful,
        100.0 * DOUBTFUL
    ))?;
    Ok(())
}
