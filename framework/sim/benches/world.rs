//! Speed of the world on one core: frames of 1/60 s a second, so that 60 are real time.

#![allow(missing_docs, reason = "criterion's macros make public items")]

use criterion::{BatchSize, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use seeone_core::random::generator;
use seeone_sim::category::cap::{Resolution, named_at};
use seeone_sim::drop::Drop;
use seeone_sim::world::FRAME_S;
use seeone_sim::{Settings, Surroundings, World};

/// The cap and the seed of its drop: one that dents and lies on its crown.
const CAP: &str = "cap-train-024";
const SEED: u64 = 1;
/// Drops that are timed from the start until they lie, s: how a cap crumples is another matter
/// with every mesh, so that one moment of one drop does not compare meshes.
const DROPS: [u64; 3] = [1, 2, 3];
const LIES_S: f64 = 2.0;
const RESOLUTIONS: [Resolution; 4] =
    [Resolution::COARSE, Resolution::STANDARD, Resolution::FINE, Resolution::FINEST];
/// Frames of a sample.
const FRAMES: usize = 6;
/// Simulated seconds after which the dropped cap lies crumpled on the table.
const CRUMPLED_S: f64 = 1.0;

fn dropped(resolution: Resolution, substeps: usize, seed: u64) -> World {
    let cap = named_at(CAP, resolution).expect("a cap of this name");
    let table = Surroundings { table: true, ..Surroundings::default() };
    let settings = Settings { substeps, ..Settings::default() };
    Drop::draw([0.0; 2], &mut generator(seed, CAP)).begin(&cap, table, settings)
}

fn speed(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("world");
    group.throughput(Throughput::Elements(FRAMES as u64)).sample_size(20);
    for resolution in RESOLUTIONS {
        for substeps in [20, 40] {
            let fresh = dropped(resolution, substeps, SEED);
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

fn whole_drops(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("drops");
    let frames = (DROPS.len() as f64 * LIES_S / FRAME_S).round() as u64;
    group.throughput(Throughput::Elements(frames)).sample_size(10);
    for resolution in RESOLUTIONS {
        let fresh = DROPS.map(|seed| dropped(resolution, 40, seed));
        let id = BenchmarkId::new("whole/40 substeps", fresh[0].vertices().len());
        group.bench_with_input(id, &fresh, |bencher, fresh| {
            let lie = |mut worlds: [World; DROPS.len()]| {
                for world in &mut worlds {
                    while world.time() < LIES_S {
                        world.advance();
                    }
                }
                worlds
            };
            bencher.iter_batched(|| fresh.clone(), lie, BatchSize::SmallInput);
        });
    }
    group.finish();
}

criterion_group!(benches, speed, whole_drops);
criterion_main!(benches);
