//! Speed of the world on one core: frames of 1/60 s a second, so that 60 are real time.

#![allow(missing_docs, reason = "criterion's macros make public items")]

use criterion::{BatchSize, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use seeone_core::random::generator;
use seeone_sim::category::cap::{Resolution, named_at};
use seeone_sim::drop::Drop;
use seeone_sim::{Settings, Surroundings, World};

/// The cap and the seed of its drop: one that dents and lies on its crown.
const CAP: &str = "cap-train-024";
const SEED: u64 = 1;
/// Frames of a sample.
const FRAMES: usize = 6;
/// Simulated seconds after which the dropped cap lies crumpled on the table.
const CRUMPLED_S: f64 = 1.0;

fn dropped(resolution: Resolution, substeps: usize) -> World {
    let cap = named_at(CAP, resolution).expect("a cap of this name");
    let table = Surroundings { table: true, ..Surroundings::default() };
    let settings = Settings { substeps, ..Settings::default() };
    Drop::draw([0.0; 2], &mut generator(SEED, CAP)).begin(&cap, table, settings)
}

fn speed(criterion: &mut Criterion) {
    let resolutions =
        [Resolution::COARSE, Resolution::STANDARD, Resolution::FINE, Resolution::FINEST];
    let mut group = criterion.benchmark_group("world");
    group.throughput(Throughput::Elements(FRAMES as u64)).sample_size(20);
    for resolution in resolutions {
        for substeps in [20, 40] {
            let fresh = dropped(resolution, substeps);
            let mut crumpled = fresh.clone();
            while crumpled.time() < CRUMPLED_S {
                crumpled.advance();
            }

            for (scene, world) in [("falling", &fresh), ("crumpled", &crumpled)] {
                let name = format!("{scene}/{substeps} substeps");
                let id = BenchmarkId::new(name, world.vertices().len());
                group.bench_with_input(id, world, |bencher, world| {
                    let advance = |mut w: World| {
                        (0..FRAMES).for_each(|_| w.advance());
                        w
                    };
                    bencher.iter_batched(|| world.clone(), advance, BatchSize::SmallInput);
                });
            }
        }
    }
    group.finish();
}

criterion_group!(benches, speed);
criterion_main!(benches);
