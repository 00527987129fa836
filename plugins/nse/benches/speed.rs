//! How long the encoding takes, on the shipped weights and a cloud of 2,048 points.

#![allow(missing_docs, reason = "criterion's macros make public items")]

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{Point3, Vector3};
use seeone_core::random::{Generator, generator, normal, uniform};
use seeone_nse::{Nse, OWN_COLUMNS};
use seeone_plugin::{CanonicalCloud, Encoding};
use std::path::Path;

/// The binary's allocator.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// Points of the cloud, and places that features are asked for.
const POINTS: usize = 2048;
const QUERIES: usize = 10_000;

/// A dome in the canonical cube with features of chance, `width` of them a point.
fn dome(width: usize, rng: &mut Generator) -> CanonicalCloud {
    let mut cloud = CanonicalCloud { feature_width: width, ..CanonicalCloud::default() };
    for _ in 0..POINTS {
        let n = Vector3::from_fn(|_, _| normal(rng)).normalize();
        let nocs = Point3::new(0.5 + 0.35 * n.x, 0.4 + 0.4 * n.y, 0.3 + 0.4 * n.z.abs());
        cloud.points.push(Point3::from(nocs.coords * 0.27));
        cloud.nocs.push(nocs);
        cloud.confidence.push([0.9; 3]);
        cloud.features.extend((0..width).map(|_| normal(rng) as f32));
    }
    cloud
}

fn encoding(criterion: &mut Criterion) {
    let plugins = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let perception = plugins.join("nst/weights");
    let mut nse = Nse::load(&plugins.join("nse/weights"), &perception).expect("shipped weights");
    let mut rng = generator(1, "dome");
    let cloud = dome(nse.columns() - OWN_COLUMNS, &mut rng);
    let mut place = || Point3::from([(); 3].map(|()| uniform(&mut rng, 0.0, 1.0)));
    let queries: Vec<Point3<f64>> = (0..QUERIES).map(|_| place()).collect();
    let field = nse.encode(&cloud).expect("a field");

    let mut group = criterion.benchmark_group("nse");
    group.sample_size(20);
    group.bench_function("volume of 2,048 points", |b| b.iter(|| nse.encode(&cloud)));
    group.bench_function("features of 10,000 points", |b| b.iter(|| field.features(&queries)));
    group.bench_function("winding of 10,000 points", |b| b.iter(|| field.winding(&queries)));
}

criterion_group!(benches, encoding);
criterion_main!(benches);
