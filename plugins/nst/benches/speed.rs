//! Speed of the perception on one core: inference with the shipped weights, and a training
//! step of the refiner. `benches/torch_speed.py` measures the same step in PyTorch.

#![allow(missing_docs, reason = "criterion's macros make public items")]

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{Point3, Vector3};
use seeone_core::random::{Generator, generator, normal, uniform};
use seeone_nn::ops::{BinTargets, cross_entropy};
use seeone_nn::sampling::Point;
use seeone_nst::batch::{Batch, View};
use seeone_nst::inference::MOST_POINTS;
use seeone_nst::network::{Network, Sizes};
use seeone_nst::stance::{Lens, Stance};
use seeone_nst::{Effort, Nst};
use std::path::Path;

/// The binary's allocator.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// Clouds of a training step on one core: half a batch.
const CLOUDS: usize = 4;

/// Points on a dome of the size of a cap, metres.
fn dome(count: usize, rng: &mut Generator) -> Vec<Point3<f64>> {
    let on = |rng: &mut Generator| {
        let n = Vector3::from_fn(|_, _| normal(rng)).normalize();
        Point3::new(0.10 * n.x, 0.12 * n.y, 0.11 * n.z.abs())
    };
    (0..count).map(|_| on(rng)).collect()
}

fn inference(criterion: &mut Criterion) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("weights");
    let cloud = dome(MOST_POINTS, &mut generator(1, "dome"));
    let camera = Point3::new(0.5, -0.2, 0.7);
    let mut group = criterion.benchmark_group("perceive 2,048 points");
    for (name, effort) in [("one pass", Effort::OnePass), ("all passes", Effort::Full)] {
        let nst = Nst::load(&folder).expect("the shipped weights").with_effort(effort);
        group.bench_function(name, |b| b.iter(|| nst.perceive(&cloud, &camera).expect("a cloud")));
    }
}

fn training(criterion: &mut Criterion) {
    let sizes = Sizes::REFINER;
    let network = Network::new(sizes, 1).expect("a network");
    let mut rng = generator(2, "clouds");
    let camera = Point3::new(0.5, -0.2, 0.7);
    let mut cloud = || -> (Vec<Point>, Stance) {
        let points: Vec<Vector3<f64>> =
            dome(sizes.points, &mut rng).into_iter().map(|p| p.coords).collect();
        let lens = Lens::coarse(&points, &camera);
        (points.iter().map(|p| lens.see(p)).collect(), lens.stance(&camera))
    };
    let clouds: Vec<(Vec<Point>, Stance)> = (0..CLOUDS).map(|_| cloud()).collect();
    let views: Vec<View<'_>> = clouds
        .iter()
        .map(|(c, stance)| View { points: c, queries: &c[..sizes.points / 2], stance: *stance })
        .collect();
    let queries = CLOUDS * sizes.points / 2;
    let targets = BinTargets {
        values: (0..3 * queries).map(|_| uniform(&mut rng, 0.0, 1.0) as f32).collect(),
        weights: vec![1.0; queries],
        softness: 1.5,
    };
    let batch = Batch::new(sizes, &views).expect("a batch");

    let mut group = criterion.benchmark_group("refiner, 4 clouds of 512 points");
    group.sample_size(20);
    group.bench_function("neighbourhoods", |b| b.iter(|| Batch::new(sizes, &views)));
    group.bench_function("forward", |b| b.iter(|| network.forward(&batch).expect("logits")));
    group.bench_function("forward and backward", |b| {
        b.iter(|| {
            let logits = network.forward(&batch).expect("logits").logits;
            let loss = cross_entropy(&logits, targets.clone()).expect("a loss");
            network.parameters().gradients(&loss.backward().expect("gradients"))
        });
    });
}

criterion_group!(benches, inference, training);
criterion_main!(benches);
