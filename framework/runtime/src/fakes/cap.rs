//! The simplest cap: half an ellipsoid with a flat visor, in its canonical cube.

use nalgebra::Point3;
use seeone_core::Similarity;
use seeone_plugin::CanonicalCloud;

/// Points of the cap in its canonical cube; the visor's tip is at (0.5, 1, 0.35).
pub(crate) fn canonical_cap() -> Vec<Point3<f64>> {
    let mut points = Vec::new();
    for ring in 0..12 {
        for i in 0..24 {
            let (up, around) =
                (f64::from(ring) / 12.0, f64::from(i) / 24.0 * std::f64::consts::TAU);
            let radius = (1.0 - up * up).sqrt() * 0.33;
            points.push(Point3::new(
                0.5 + radius * around.cos(),
                0.36 + radius * around.sin() * 1.09,
                0.35 + 0.4 * up,
            ));
        }
    }
    for row in 0..10 {
        for column in -7..=7 {
            let (out, across) = (f64::from(row) / 9.0, f64::from(column) / 7.0);
            points.push(Point3::new(0.5 + 0.3 * across, 0.7 + 0.3 * out, 0.35));
        }
    }
    points
}

/// That cap placed in the world, perceived without error.
pub(crate) fn canonical_cloud(placed: &Similarity) -> CanonicalCloud {
    let nocs = canonical_cap();
    CanonicalCloud {
        points: nocs.iter().map(|c| placed * c).collect(),
        confidence: vec![[1.0; 3]; nocs.len()],
        features: vec![0.0; nocs.len()],
        feature_width: 1,
        nocs,
    }
}
