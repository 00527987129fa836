//! Times of the planner: one check of the whole arm, free paths where the straight move is
//! blocked, and the timing of a move.
//!
//! `cargo bench -p seeone-motion` prints criterion's figures, and of the paths how they are
//! spread: of each pair the best of several runs, which is what the machine does when nothing
//! else disturbs it.

#![allow(clippy::print_stdout, reason = "a table is what it is for")]

use criterion::Criterion;
use nalgebra::{Point3, Vector3};
use seeone_collision::{Checker, Convex};
use seeone_core::random::{direction, generator};
use seeone_motion::{MotionConfig, Planner};
use seeone_plugin::Clearance;
use std::hint::black_box;
use std::time::Instant;

#[path = "../tests/support/pairs.rs"]
mod pairs;

use pairs::{MARGINS, PAIRS, blocked, cell, free_posture, ur5};

const RUNS: usize = 3;

/// A hull of 128 points, the size of a cap, in front of the pads.
fn cap() -> Convex {
    let mut rng = generator(3, "cap");
    let points: Vec<Point3<f64>> = (0..128)
        .map(|_| direction(&mut rng).component_mul(&Vector3::new(0.09, 0.12, 0.06)))
        .map(|p| Point3::from(p + Vector3::new(0.0, 0.0, 0.10)))
        .collect();
    Convex::hull(&points).expect("points")
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let robot = ur5();
    let checker = Checker::new(&robot, MARGINS, &cell(), 0.05);
    let mut rng = generator(2, "postures");
    let postures: Vec<Vec<f64>> = (0..500).map(|_| free_posture(&checker, &mut rng)).collect();
    let laden = Checker::new(&robot, MARGINS, &cell(), 0.05).carrying(cap());
    let free: Vec<Vec<f64>> =
        postures.iter().filter(|q| laden.contact(q).is_none()).cloned().collect();
    for (name, checker, postures) in
        [("with an empty hand", &checker, &postures), ("with a hull in the hand", &laden, &free)]
    {
        let time = || {
            let clock = Instant::now();
            postures.iter().for_each(|q| assert!(black_box(checker.contact(q)).is_none()));
            1e6 * clock.elapsed().as_secs_f64() / postures.len() as f64
        };
        let best = (0..30).map(|_| time()).fold(f64::INFINITY, f64::min);
        println!("a check of the whole arm {name}, nothing found: {best:.2} us");
        let mut next = postures.iter().cycle();
        criterion.bench_function(&format!("a check {name}"), |bencher| {
            bencher.iter(|| checker.contact(black_box(next.next().expect("a cycle"))));
        });
    }

    let planner = Planner::new(MotionConfig::default(), 1).expect("options");
    let pairs = blocked(&robot, &checker, true);
    let mut times = Vec::with_capacity(PAIRS);
    let (mut found, mut lengths) = (0, Vec::new());
    for [start, goal] in &pairs {
        let time = || {
            let clock = Instant::now();
            let path = planner.free_path(&robot, &checker, start, goal);
            (1e3 * clock.elapsed().as_secs_f64(), path)
        };
        let runs: Vec<_> = (0..RUNS).map(|_| time()).collect();
        times.push(runs.iter().map(|run| run.0).fold(f64::INFINITY, f64::min));
        if let Ok(path) = &runs[0].1 {
            found += 1;
            let length = |pair: &[Vec<f64>]| {
                pair[0].iter().zip(&pair[1]).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
            };
            lengths.push(path.windows(2).map(length).sum::<f64>());
        }
    }
    times.sort_by(f64::total_cmp);
    lengths.sort_by(f64::total_cmp);
    println!(
        "{found} of {PAIRS} blocked pairs: median {:.2}, 95 % {:.2}, worst {:.2} ms; median length {:.1} rad",
        times[PAIRS / 2],
        times[PAIRS * 95 / 100],
        times[PAIRS - 1],
        lengths[lengths.len() / 2]
    );
    let mut next = pairs.iter().cycle();
    criterion.bench_function("a free path where the straight move is blocked", |bencher| {
        bencher.iter(|| {
            let [start, goal] = next.next().expect("a cycle");
            planner.free_path(&robot, &checker, start, goal)
        });
    });
    criterion.final_summary();
}
