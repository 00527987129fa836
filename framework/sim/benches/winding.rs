//! The winding number of a worn cap of about 1,000 vertices on one core: a 128^3 grid, and
//! single points. `benches/winding_libigl.py` times libigl on the same mesh and grid.

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{Point3, Vector3};
use seeone_core::random::{generator, uniform};
use seeone_core::winding::Exact;
use seeone_sim::category::cap::{self, Resolution};
use seeone_sim::{Settings, worn::worn};
use std::hint::black_box;

const VOXELS: usize = 128;
const POINTS: usize = 1000;

fn winding(c: &mut Criterion) {
    let object = cap::named_at("cap-train-000", Resolution::FINE).expect("a cap");
    let worn = worn(&object, &Settings::default()).expect("it sits");
    let mesh = worn.canonical.mesh().expect("a mesh");
    let exact = Exact::new(&mesh);
    let step = 1.0 / VOXELS as f64;
    let low = Point3::from([0.5 * step; 3]);
    let mut rng = generator(1, "points");
    let points: Vec<Point3<f64>> = (0..POINTS)
        .map(|_| Point3::from(Vector3::from_fn(|_, _| uniform(&mut rng, 0.0, 1.0))))
        .collect();

    let mut group = c.benchmark_group("winding");
    group.sample_size(10);
    group.bench_function("grid of 128^3", |b| b.iter(|| exact.grid(&low, step, [VOXELS; 3])));
    group.bench_function("1000 points", |b| {
        b.iter(|| points.iter().map(|p| exact.at(black_box(p))).sum::<f64>());
    });
    group.finish();
}

criterion_group!(benches, winding);
criterion_main!(benches);
