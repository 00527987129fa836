//! Times of the planner: one check of the whole arm, free paths where the straight move is
//! blocked, and the timing of a move.
//!
//! `cargo bench -p seeone-motion` prints criterion's figures, and of the paths how they are
//! spread: of each pair the best of several runs, which is what the machine does when nothing
//! else disturbs it.

#![allow(clippy::print_stdout, reason = "a table is what it is for")]

use criterion::Criterion;
use nalgebra::Vector3;
use seeone_collision::{Checker, Margins};
use seeone_core::Pose;
use seeone_core::random::{Generator, generator, uniform};
use seeone_core::robot::{RobotModel, RobotOptions, Shape, Solid};
use seeone_motion::{MotionConfig, Planner};
use seeone_plugin::Clearance;
use seeone_plugin::motion::Obstacle;
use std::f64::consts::PI;
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

const PAIRS: usize = 200;
const RUNS: usize = 3;
/// The arm's distance from everything, metres.
const MARGINS: Margins = Margins { clearance_m: 0.005, carried_m: 0.03 };

fn ur5() -> RobotModel {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/ur5-ag95.urdf");
    RobotModel::from_urdf(&file, &RobotOptions::default()).expect("the shipped robot")
}

/// A table, a shelf of two boards on it, and a post.
fn cell() -> Vec<Obstacle> {
    let block = |name: &str, at: [f64; 3], half: [f64; 3]| {
        Obstacle::Solid(Solid {
            part: name.into(),
            shape: Shape::Box { half_m: Vector3::from(half) },
            pose: Pose::translation(at[0], at[1], at[2]),
        })
    };
    vec![
        Obstacle::Table { height_m: -0.02, soft_m: 0.0 },
        block("lower board", [0.55, 0.0, 0.30], [0.15, 0.35, 0.01]),
        block("upper board", [0.55, 0.0, 0.65], [0.15, 0.35, 0.01]),
        block("post", [-0.35, 0.35, 0.45], [0.04, 0.04, 0.45]),
    ]
}

fn free_posture(checker: &Checker, rng: &mut Generator) -> Vec<f64> {
    loop {
        let q: Vec<f64> = (0..6).map(|_| uniform(rng, -PI, PI)).collect();
        if checker.contact(&q).is_none() {
            return q;
        }
    }
}

/// Free postures whose straight connection is blocked.
fn blocked_pairs(checker: &Checker) -> Vec<[Vec<f64>; 2]> {
    let mut rng = generator(1, "pairs");
    let mut pairs = Vec::with_capacity(PAIRS);
    while pairs.len() < PAIRS {
        let (a, b) = (free_posture(checker, &mut rng), free_posture(checker, &mut rng));
        let mut on_the_way = (1..200)
            .map(|k| f64::from(k) / 200.0)
            .map(|share| a.iter().zip(&b).map(|(a, b)| a + share * (b - a)).collect::<Vec<f64>>());
        if on_the_way.any(|q| checker.contact(&q).is_some()) {
            pairs.push([a, b]);
        }
    }
    pairs
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let robot = ur5();
    let checker = Checker::new(&robot, MARGINS, &cell(), 0.05);
    let mut rng = generator(2, "postures");
    let postures: Vec<Vec<f64>> = (0..500).map(|_| free_posture(&checker, &mut rng)).collect();
    let mut next = postures.iter().cycle();
    criterion.bench_function("a check of the whole arm that finds nothing", |bencher| {
        bencher.iter(|| checker.contact(black_box(next.next().expect("a cycle"))));
    });

    let planner = Planner::new(MotionConfig::default(), 1).expect("options");
    let pairs = blocked_pairs(&checker);
    let mut times = Vec::with_capacity(PAIRS);
    let (mut found, mut lengths) = (0, Vec::new());
    let mut solved = Vec::new();
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
            solved.push(times[times.len() - 1]);
            let length = |pair: &[Vec<f64>]| {
                pair[0].iter().zip(&pair[1]).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
            };
            lengths.push(path.windows(2).map(length).sum::<f64>());
        }
    }
    times.sort_by(f64::total_cmp);
    lengths.sort_by(f64::total_cmp);
    solved.sort_by(f64::total_cmp);
    println!(
        "those found: median {:.2}, 95 % {:.2} ms",
        solved[solved.len() / 2],
        solved[solved.len() * 95 / 100]
    );
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
