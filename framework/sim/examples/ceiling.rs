//! What wearing can reach at best, and what it forgives: caps are let go on the head where
//! they are worn, and beside it by known errors; prints a Markdown table.
//! `ceiling [--caps N] [--all] [--seed S]`: the unseen and validation sets, the first N of
//! them, or every cap there is.

use rayon::prelude::*;
use seeone_core::Pose;
use seeone_core::random::generator;
use seeone_sim::category::cap::{self, Set};
use seeone_sim::put_on::{Misplacement, put_on};
use seeone_sim::worn::{Worn, worn};
use seeone_sim::{Head, Object, Settings, WearError};
use std::error::Error;
use std::io::Write;

/// Height of the head over the table, metres.
const HEAD_M: f64 = 0.3;
/// Errors of the release: millimetres and degrees.
const ERRORS: [(f64, f64); 7] =
    [(0.0, 0.0), (5.0, 0.0), (10.0, 0.0), (20.0, 0.0), (0.0, 3.0), (0.0, 6.0), (0.0, 12.0)];

/// One release.
#[derive(Clone, Copy)]
struct Trial {
    error: WearError,
    at_rest: bool,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |flag: &str| -> Result<Option<u64>, Box<dyn Error>> {
        let Some(at) = arguments.iter().position(|a| a == flag) else { return Ok(None) };
        Ok(Some(arguments.get(at + 1).ok_or("a flag lacks its number")?.parse()?))
    };
    let seed = number("--seed")?.unwrap_or(1);
    let sets: &[Set] = if arguments.iter().any(|a| a == "--all") {
        &Set::DISJOINT
    } else {
        &[Set::Unseen, Set::Validation]
    };
    let mut names: Vec<String> = sets.iter().flat_map(|set| cap::names(*set)).collect();
    names.truncate(number("--caps")?.map_or(usize::MAX, |caps| caps as usize));
    let normal = Settings::default();
    let fine = Settings { substeps: 2 * normal.substeps, ..normal };
    let caps = settled(&names, &normal);
    let mut out = std::io::stdout().lock();
    writeln!(out, "{} of {} caps have a worn state; seed {seed}.\n", caps.len(), names.len())?;
    writeln!(
        out,
        "| error | trials | d mean | d max | < 0.05 d | < 0.1 d | < 0.2 d | tilt mean (max), deg \
         | yaw mean (max), deg | at rest |\n|---|---|---|---|---|---|---|---|---|---|"
    )?;
    let mut ideal = Vec::new();
    for (shift_mm, turn_deg) in ERRORS {
        let trials = release(&caps, (shift_mm, turn_deg), seed, &normal);
        writeln!(out, "{}", row(&label(shift_mm, turn_deg), &trials))?;
        if shift_mm == 0.0 && turn_deg == 0.0 {
            ideal = trials;
        }
    }
    let refined = settled(&names, &fine);
    let trials = release(&refined, (0.0, 0.0), seed, &fine);
    writeln!(out, "{}", row(&format!("none, {} substeps", fine.substeps), &trials))?;
    writeln!(out, "\nWith twice the substeps, cap by cap, d:\n")?;
    writeln!(out, "| cap | error | error at {0} | v_t moved by |", fine.substeps)?;
    writeln!(out, "|---|---|---|---|")?;
    for ((object, worn), trial) in caps.iter().zip(&ideal) {
        let same = refined.iter().zip(&trials).find(|((o, _), _)| o.name() == object.name());
        if let Some(((_, finer), again)) = same {
            let moved = WearError::of(worn, &finer.vertices).mean_d;
            let [a, b] = [trial, again].map(|t| t.error.mean_d);
            writeln!(out, "| {} | {a:.4} | {b:.4} | {moved:.4} |", object.name())?;
        }
    }
    Ok(())
}

/// The caps of these names that have a worn state.
fn settled(names: &[String], settings: &Settings) -> Vec<(Object, Worn)> {
    let one = |name: &String| {
        let object = cap::named(name)?;
        let worn = worn(&object, settings).ok()?;
        Some((object, worn))
    };
    names.par_iter().filter_map(one).collect()
}

/// Lets every cap go with an error of millimetres and degrees in a direction of its own.
fn release(
    caps: &[(Object, Worn)],
    (shift_mm, turn_deg): (f64, f64),
    seed: u64,
    settings: &Settings,
) -> Vec<Trial> {
    let head = Head::medium(Pose::translation(0.0, 0.0, HEAD_M));
    let one = |(object, worn): &(Object, Worn)| {
        let stream = format!("{}/{shift_mm}/{turn_deg}", object.name());
        let mut rng = generator(seed, &stream);
        let misplaced = Misplacement::draw(shift_mm / 1e3, turn_deg.to_radians(), &mut rng);
        let end = put_on(object, worn, head, &misplaced, settings);
        let error = WearError::of(worn, &end.reached(&head));
        Trial { error, at_rest: end.settled.at_rest }
    };
    caps.par_iter().map(one).collect()
}

fn label(shift_mm: f64, turn_deg: f64) -> String {
    match (shift_mm > 0.0, turn_deg > 0.0) {
        (true, _) => format!("{shift_mm} mm"),
        (_, true) => format!("{turn_deg} deg"),
        _ => "none".into(),
    }
}

fn row(label: &str, trials: &[Trial]) -> String {
    let count = trials.len();
    let mean_max = |of: &dyn Fn(&WearError) -> f64| {
        let values: Vec<f64> = trials.iter().map(|t| of(&t.error)).collect();
        let mean = values.iter().sum::<f64>() / count.max(1) as f64;
        (mean, values.iter().copied().fold(0.0, f64::max))
    };
    let (mean, most) = mean_max(&|e| e.mean_d);
    let (tilt, most_tilt) = mean_max(&|e| e.tilt_deg);
    let (yaw, most_yaw) = mean_max(&|e| e.yaw_deg.abs());
    let within = |d: f64| trials.iter().filter(|t| t.error.mean_d < d).count();
    let at_rest = trials.iter().filter(|t| t.at_rest).count();
    format!(
        "| {label} | {count} | {mean:.4} | {most:.4} | {} | {} | {} | {tilt:.1} ({most_tilt:.1}) \
         | {yaw:.1} ({most_yaw:.1}) | {at_rest} |",
        within(0.05),
        within(0.1),
        within(0.2),
    )
}
