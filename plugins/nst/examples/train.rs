//! Trains NST outside the command line tool: `train DATA OUT COARSE REFINER [MEASURE_ON..]`.
#![allow(clippy::print_stderr, reason = "an example talks to its user")]

use seeone_nst::{TrainPlan, train};
use std::ops::ControlFlow;
use std::time::Instant;

#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [data, out, coarse, refiner, others @ ..] = arguments.as_slice() else {
        return Err("usage: train DATA OUT COARSE_SAMPLES REFINER_SAMPLES [MEASURE_ON..]".into());
    };
    let plan = TrainPlan {
        data: data.into(),
        measure_on: others
            .iter()
            .map(|set| (set.rsplit('/').next().unwrap_or(set).to_owned(), set.into()))
            .collect(),
        out: out.into(),
        seed: 1,
        coarse_samples: coarse.parse()?,
        refiner_samples: refiner.parse()?,
        category: "cap".into(),
        command: format!(
            "seeone train nst --data {data} --out {out} --coarse {coarse} --refiner {refiner}"
        ),
    };
    let start = Instant::now();
    let report = train(&plan, &mut |told| {
        let (seconds, p) = (start.elapsed().as_secs_f64(), told.progress);
        eprintln!("{seconds:7.1} s  {:?} {} / {}  loss {:.3}", told.stage, p.done, p.total, p.loss);
        ControlFlow::Continue(())
    })?;
    eprintln!("{:.1} s  {report:#?}", start.elapsed().as_secs_f64());
    Ok(())
}
