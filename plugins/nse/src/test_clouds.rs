//! Canonical clouds of the test caps, as a perception would give them.

use crate::test_caps::cap;
use nalgebra::{Point3, Vector3};
use seeone_core::random::{generator, normal, uniform};
use seeone_plugin::CanonicalCloud;

/// Features a point in these clouds.
pub(crate) const WIDTH: usize = 8;

/// How much higher than the smallest the crown of cap `index` is.
pub(crate) fn growth(index: usize) -> f64 {
    0.04 * (index % 8) as f64
}

/// `count` noisy points of the front and top of cap `index`, scaled to metres.
pub(crate) fn cloud(index: usize, count: usize) -> CanonicalCloud {
    let mesh = cap(growth(index));
    let mut rng = generator(index as u64, "test cloud");
    let mut cloud = CanonicalCloud { feature_width: WIDTH, ..CanonicalCloud::default() };
    while cloud.len() < count {
        let triangle = uniform(&mut rng, 0.0, mesh.triangles().len() as f64) as usize;
        let [a, b, c] = mesh.corners(triangle);
        let u = uniform(&mut rng, 0.0, 1.0);
        let v = uniform(&mut rng, 0.0, 1.0 - u);
        let nocs: Point3<f64> = a + (b - a) * u + (c - a) * v;
        if nocs.y < 0.3 {
            continue; // the back is hidden
        }
        let noise = Vector3::from_fn(|_, _| 0.01 * normal(&mut rng));
        cloud.points.push(Point3::from(nocs.coords * 0.28));
        cloud.nocs.push(nocs + noise);
        cloud.confidence.push([0.6; 3]);
        cloud.features.extend((0..WIDTH).map(|k| (nocs[k % 3] as f32 * (k + 1) as f32).sin()));
    }
    cloud
}
