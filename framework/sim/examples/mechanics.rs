//! The validation of the world against mechanics as Markdown tables: `mechanics`; or its
//! speed and shape loss beside rapier's soft bodies: `mechanics peer [DROPS]`.

#[path = "../tests/validation/scenes/mod.rs"]
mod scenes;

use scenes::bending::{SUBSTEPS, convergence};
use scenes::hanging::{elastic_gains, resolution};
use scenes::reference::{Dropped, Solver, dropped};
use std::error::Error;
use std::fs;
use std::io::{self, Write};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    match arguments.next().as_deref() {
        None => validation()?,
        Some("peer") => peer(arguments.next().map_or(Ok(3), |n| n.parse())?)?,
        Some(other) => return Err(format!("there is no \"{other}\", only peer").into()),
    }
    Ok(())
}

fn validation() -> io::Result<()> {
    let mut out = io::stdout().lock();
    writeln!(out, "| quantity | formula | expected | measured | deviation | bar | |")?;
    writeln!(out, "|---|---|---|---|---|---|---|")?;
    for check in scenes::ALL.iter().flat_map(|scene| scene()) {
        writeln!(out, "{check}")?;
    }
    writeln!(out, "\n| kg/m2 | sag, mm | of its length | edges of 20 mm | of 10 mm |")?;
    writeln!(out, "|---|---|---|---|---|")?;
    for row in resolution() {
        let [sag_m, _] = row.sags_m;
        let [coarse, fine] = row.deviations.map(|d| 100.0 * d);
        write!(
            out,
            "| {} | {:.2} | {:.2} % ",
            row.density_kg_m2,
            1e3 * sag_m,
            100.0 * sag_m / 0.3
        )?;
        writeln!(out, "| {coarse:+.0} % | {fine:+.0} % |")?;
    }
    writeln!(out, "\n| substeps | pendulum with elastic energy gains |\n|---|---|")?;
    for (substeps, gained) in elastic_gains() {
        writeln!(out, "| {substeps} | {gained:.3} |")?;
    }
    write!(out, "\n| B, N m | length, mm | edges, mm |")?;
    SUBSTEPS.iter().try_for_each(|substeps| write!(out, " {substeps} substeps |"))?;
    writeln!(out, "\n|---|---|---|{}", "---|".repeat(SUBSTEPS.len()))?;
    for row in convergence() {
        let (length, edge) = (row.length_m * 1e3, row.edge_m * 1e3);
        write!(out, "| {:e} | {length:.0} | {edge:.0} |", row.bending_n_m)?;
        row.deviations.iter().try_for_each(|d| write!(out, " {:+.0} % |", 100.0 * d))?;
        writeln!(out)?;
    }
    Ok(())
}

/// Drops the same cap `drops` times in every solver.
fn peer(drops: u64) -> io::Result<()> {
    let mut out = io::stdout().lock();
    writeln!(
        out,
        "| solver | simulated s a CPU second | shape loss | of the visor | speed at 3 s |"
    )?;
    writeln!(out, "|---|---|---|---|---|")?;
    for (name, solver) in [
        ("own, 20 substeps", Solver::Own(20)),
        ("own, 40 substeps", Solver::Own(40)),
        ("rapier, stiff visor", Solver::StiffVisor),
        ("rapier, weak whole", Solver::WeakWhole),
    ] {
        let started = cpu_s()?;
        let ends: Vec<Dropped> = (0..drops).map(|seed| dropped(solver, seed)).collect();
        let rate = 3.0 * drops as f64 / (cpu_s()? - started);
        let mean = |of: fn(&Dropped) -> f64| 1e3 * ends.iter().map(of).sum::<f64>() / drops as f64;
        let (shape, visor) = (mean(|d| d.shape_loss_m), mean(|d| d.visor_loss_m));
        let speed = mean(|d| d.speed_m_s);
        write!(out, "| {name} | {rate:.2} | {shape:.1} mm | {visor:.2} mm | ")?;
        writeln!(out, "{speed:.1} mm/s |")?;
    }
    Ok(())
}

/// Time that this thread has spent on a core, s, as Linux counts it: the machine may be busy
/// with something else.
fn cpu_s() -> io::Result<f64> {
    let text = fs::read_to_string("/proc/thread-self/schedstat")?;
    let spent = text.split_whitespace().next().and_then(|ns| ns.parse::<f64>().ok());
    Ok(1e-9 * spent.ok_or(io::ErrorKind::InvalidData)?)
}
