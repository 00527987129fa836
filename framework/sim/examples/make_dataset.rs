//! Generates a training set and tells how long it took:
//! `make_dataset FOLDER CAPS FRAMES VIEWS`

use seeone_sim::category::cap::{self, Set};
use seeone_sim::dataset::{Plan, generate};
use std::error::Error;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [folder, caps, frames, views] = arguments.as_slice() else {
        return Err("usage: make_dataset FOLDER CAPS FRAMES VIEWS".into());
    };
    std::fs::create_dir_all(folder)?;
    let names = cap::names(Set::Train).into_iter().take(caps.parse()?);
    let plan = Plan {
        objects: names.filter_map(|n| cap::named(&n)).collect(),
        frames: frames.parse()?,
        views: views.parse()?,
        seed: 1,
        command: format!("make_dataset {}", arguments.join(" ")),
    };
    let start = Instant::now();
    let summary = generate(&plan, Path::new(folder), &|_| ())?;
    let seconds = start.elapsed().as_secs_f64();
    writeln!(
        std::io::stdout(),
        "{summary:?} in {seconds:.1} s, {:.2} s a frame",
        seconds / summary.frames() as f64
    )?;
    Ok(())
}
