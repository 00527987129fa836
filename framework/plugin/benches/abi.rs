//! What crossing the ABI costs: a question without content and a cloud of 2,048 points, each
//! called directly and watched on a thread of its own, and the cloud linked. Beside criterion's
//! figures it prints the median and the shortest time of each, which other work on the machine
//! does not disturb.

#![allow(clippy::print_stdout, reason = "a table is what it is for")]

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use nalgebra::Point3;
use seeone_core::Cloud;
use seeone_plugin::abi::{Library, Manifest};
use seeone_plugin::{CanonicalCloud, Observation, Perception, Robot, Setup};
use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

/// The library of idle plugins, built beside this benchmark.
fn library() -> PathBuf {
    let build = ["build", "--release", "--quiet", "-p", "seeone-plugin", "--example", "idle"];
    let built = Command::new(env!("CARGO")).args(build).status();
    assert!(built.is_ok_and(|status| status.success()), "the library cannot be built");
    let program = std::env::current_exe().expect("a running benchmark has a path");
    let target = program.ancestors().nth(2).expect("benchmarks lie in PROFILE/deps");
    let name = format!("{}idle{}", std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    target.join("examples").join(name)
}

/// Perceives nothing of anything, as the library's does.
struct Idle;

impl Perception for Idle {
    fn perceive(
        &mut self,
        observation: &Observation,
    ) -> Result<CanonicalCloud, seeone_plugin::PluginError> {
        black_box(observation.cloud.points());
        Ok(CanonicalCloud::default())
    }
}

/// Calls of which the shortest counts.
const CALLS: usize = 20_000;

/// A line of the table.
fn table<T>(name: &str, mut call: impl FnMut() -> T) {
    let time = |_| {
        let clock = Instant::now();
        black_box(call());
        1e6 * clock.elapsed().as_secs_f64()
    };
    let mut times: Vec<f64> = (0..CALLS).map(time).collect();
    times.sort_by(f64::total_cmp);
    println!("| {name:<22} | {:>6.2} | {:>6.2} |", times[CALLS / 2], times[0]);
}

fn crossing(criterion: &mut Criterion) {
    let path = library();
    Manifest::write_for(&path).expect("a sound library");
    let library = Library::open(&path).expect("trusted");
    let config = toml::Table::new();
    let setup = Setup { config: &config, root: Path::new("."), seed: 0, world: None, robot: None };
    let build = |index: usize, patience| {
        library.offers()[index].build(&setup, patience).expect("an idle plugin")
    };
    let watched = Some(Duration::from_secs(60));
    let points = (0..2048).map(|i| Point3::new(f64::from(i), 0.5, -1.0)).collect();
    let cloud = Cloud::new(points).expect("finite points");
    let observation = Observation { depth: None, cloud, camera_position: Point3::origin() };

    println!("| {:<22} | median us | shortest us |\n|---|---|---|", "of 20,000 calls");
    let mut group = criterion.benchmark_group("abi");
    for (name, patience) in [("direct", None), ("watched", watched)] {
        let mut robot = build(1, patience);
        let mut perception = build(0, patience);
        table(&format!("state, {name}"), || robot.state());
        table(&format!("2048 points, {name}"), || perception.perceive(black_box(&observation)));
        group.bench_function(BenchmarkId::new("state", name), |b| b.iter(|| robot.state()));
        group.bench_function(BenchmarkId::new("2048 points", name), |b| {
            b.iter(|| perception.perceive(black_box(&observation)));
        });
    }
    group.bench_function(BenchmarkId::new("2048 points", "linked"), |b| {
        b.iter(|| Idle.perceive(black_box(&observation)));
    });
    group.finish();
}

criterion_group!(benches, crossing);
criterion_main!(benches);
