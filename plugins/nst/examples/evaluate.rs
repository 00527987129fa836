//! Measures stored weights on sets of frames: `evaluate WEIGHTS SET..`.
#![allow(clippy::print_stdout, reason = "an example talks to its user")]

use nalgebra::Point3;
use seeone_core::frames::read_all;
use seeone_nst::{Nst, evaluate};
use std::time::Instant;

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// Frames that the time of one perception is averaged over.
const TIMED: usize = 8;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [weights, sets @ ..] = arguments.as_slice() else {
        return Err("usage: evaluate WEIGHTS SET..".into());
    };
    let nst = Nst::load(weights.as_ref())?;
    for set in sets {
        let (index, frames) = read_all(set.as_ref())?;
        let start = Instant::now();
        for frame in frames.iter().filter(|f| f.info.at_rest()).take(TIMED) {
            let points: Vec<Point3<f64>> =
                frame.points.iter().map(|p| Point3::from(p.map(f64::from))).collect();
            nst.perceive(&points, &Point3::from(frame.info.camera.xyz_m))?;
        }
        let ms = start.elapsed().as_secs_f64() * 1000.0 / TIMED as f64;
        println!("{set}: {ms:.0} ms a frame, {:#?}", evaluate(&nst, &index.objects, &frames));
    }
    Ok(())
}
