//! Drops caps from seeded poses and prints what became of them as a Markdown table:
//! `drops [DROPS [STRIDE]] [NAME...]` takes DROPS poses (5) of every STRIDE-th cap (1), or of
//! the named ones.

#[path = "../tests/common/drop_study.rs"]
mod drop_study;

use drop_study::{LIMIT_S, Outcome, study};
use rayon::prelude::*;
use seeone_sim::Settings;
use seeone_sim::category::cap::{self, Set};
use std::io::Write;

fn main() -> std::io::Result<()> {
    let (numbers, mut names): (Vec<String>, Vec<String>) =
        std::env::args().skip(1).partition(|a| a.parse::<usize>().is_ok());
    let number = |n: usize, other| numbers.get(n).and_then(|a| a.parse().ok()).unwrap_or(other);
    let (drops, stride) = (number(0, 5), number(1, 1) as usize);
    if names.is_empty() {
        names = Set::DISJOINT.into_iter().flat_map(cap::names).step_by(stride.max(1)).collect();
    }
    let settings = Settings::default();
    let outcomes: Vec<Outcome> = names
        .par_iter()
        .filter_map(|name| cap::named(name))
        .flat_map_iter(|cap| study(&cap, drops, &settings))
        .collect();
    let mut out = std::io::stdout().lock();
    let n = outcomes.len();
    let share = |of: &dyn Fn(&Outcome) -> bool| {
        let count = outcomes.iter().filter(|o| of(o)).count();
        format!("{count} of {n} ({:.1} %)", 100.0 * count as f64 / n as f64)
    };
    let worst = |of: &dyn Fn(&Outcome) -> f64| outcomes.iter().map(of).fold(f64::MIN, f64::max);
    writeln!(out, "| {} caps x {drops} drops | |\n|---|---|", names.len())?;
    writeln!(out, "| finite | {} |", share(&|o| o.finite))?;
    writeln!(out, "| deepest in the table | {:.4} mm |", -1e3 * -worst(&|o| -o.lowest_m))?;
    for limit in [2.0, 3.0, LIMIT_S] {
        let within = |t: Option<f64>| t.is_some_and(|t| t <= limit + 1e-9);
        writeln!(out, "| at rest by {limit} s: shape | {} |", share(&|o| within(o.shape_rest_s)))?;
        writeln!(out, "| at rest by {limit} s: all motion | {} |", share(&|o| within(o.rest_s)))?;
    }
    writeln!(out, "| worst strain p99 | {:.2} % |", 100.0 * worst(&|o| o.strain_p99))?;
    writeln!(out, "| worst brim hinge error RMS | {:.2} deg |", worst(&|o| o.brim_deg))?;
    writeln!(out, "| no crossing at rest | {} |", share(&|o| o.crossings == 0))?;
    writeln!(out, "| most crossings | {} |", worst(&|o| o.crossings as f64))?;
    writeln!(out, "| worn again | {} |", share(&|o| o.worn_again_m.is_some()))?;
    writeln!(
        out,
        "| worn again within 5 mm | {} |",
        share(&|o| o.worn_again_m.is_some_and(|d| d < 0.005))
    )?;
    writeln!(
        out,
        "| worst distance worn again | {:.2} mm |",
        1e3 * worst(&|o| o.worn_again_m.unwrap_or(0.0))
    )?;
    writeln!(
        out,
        "| shape again within 5 mm | {} |",
        share(&|o| o.shape_again_m.is_some_and(|d| d < 0.005))
    )?;
    writeln!(
        out,
        "| worst shape again | {:.2} mm |",
        1e3 * worst(&|o| o.shape_again_m.unwrap_or(0.0))
    )?;
    writeln!(
        out,
        "\n| outside a bar | rest s | at the end | strain p99 | brim | crossings | shape again |"
    )?;
    writeln!(out, "|---|---|---|---|---|---|---|")?;
    for o in outcomes.iter().filter(|o| !o.keeps_every_bar()) {
        let rest_s = o.rest_s.map_or("never".into(), |t| format!("{t:.2}"));
        let (speed, strain, brim) = (1e3 * o.speed_m_s, 100.0 * o.strain_p99, o.brim_deg);
        let again = o.shape_again_m.map_or("never".into(), |m| format!("{:.2} mm", 1e3 * m));
        write!(out, "| {} drop {} | {rest_s} | {speed:.1} mm/s | {strain:.2} % ", o.cap, o.drop)?;
        writeln!(out, "| {brim:.2} deg | {} | {again} |", o.crossings)?;
    }
    Ok(())
}
