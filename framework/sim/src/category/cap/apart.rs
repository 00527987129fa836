//! How far two caps of a template are from each other.

use crate::object::Object;
use nalgebra::{Point3, Vector3};

/// Distance below which two caps are the same cap.
pub const NEAR_DUPLICATE: f64 = 0.02;

/// The vertices of an object at rest, centred, its longest box edge 1.
pub fn normalised(object: &Object) -> Vec<Point3<f64>> {
    let (low, high) = object.mesh().bounds();
    let (centre, edge) = ((low.coords + high.coords) / 2.0, (high - low).max());
    object.mesh().vertices().iter().map(|v| Point3::from((v.coords - centre) / edge)).collect()
}

/// Mean distance of corresponding vertices of two normalised caps of one template.
pub fn distance(a: &[Point3<f64>], b: &[Point3<f64>]) -> f64 {
    let sum: f64 = a.iter().zip(b).map(|(a, b)| Vector3::norm(&(a - b))).sum();
    sum / a.len() as f64
}
