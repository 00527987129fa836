//! How far a wearing is from the worn state (method: Eq. 11 and 12).

use crate::rigid_fit::rigid_fit;
use crate::worn::Worn;
use nalgebra::{Point3, Rotation3, Vector3};
use std::f64::consts::TAU;

/// Angles about the head's z axis that are tried for a round object.
const TURNS: usize = 72;
/// Steps of the search between the neighbours of the best of them: to TAU / 72 / 1.6^24.
const STEPS: usize = 24;

/// What separates a reached state from the worn one. For an object whose symmetry is
/// round, the worn state is the nearest of its turns about the head's z axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WearError {
    /// Mean distance of corresponding vertices, metres.
    pub mean_m: f64,
    /// The same in diameters of the worn object.
    pub mean_d: f64,
    /// Angle between the upward axes, degrees.
    pub tilt_deg: f64,
    /// The part of it about the axis to the right, degrees, the brim up positive.
    pub nose_up_deg: f64,
    /// Turn of the forward axis about the head's z axis, degrees, to the left positive.
    /// Near zero for a round object, whose turn is taken out.
    pub yaw_deg: f64,
}

impl WearError {
    /// Compares `reached`, the object's vertices in the head frame in metres and in the order
    /// of `worn.vertices`, with the worn state.
    pub fn of(worn: &Worn, reached: &[Point3<f64>]) -> Self {
        let target = if worn.canonical.round {
            turned(&worn.vertices, nearest_turn(&worn.vertices, reached))
        } else {
            worn.vertices.clone()
        };
        let mean_m = mean_distance(&target, reached);
        let turn = rigid_fit(&target, reached).rotation;
        let (up, forward) = (turn * Vector3::z(), turn * Vector3::y());
        Self {
            mean_m,
            mean_d: mean_m / worn.diameter_m,
            tilt_deg: up.angle(&Vector3::z()).to_degrees(),
            nose_up_deg: (-up.y).atan2(up.z).to_degrees(),
            yaw_deg: (-forward.x).atan2(forward.y).to_degrees(),
        }
    }
}

fn mean_distance(a: &[Point3<f64>], b: &[Point3<f64>]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).norm()).sum::<f64>() / a.len() as f64
}

fn turned(points: &[Point3<f64>], angle: f64) -> Vec<Point3<f64>> {
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
    points.iter().map(|p| turn * p).collect()
}

/// The turn of `target` about z that brings it nearest to `reached`, radians. The distance
/// has more than one valley, so the valley is found first, and its ground by golden section.
fn nearest_turn(target: &[Point3<f64>], reached: &[Point3<f64>]) -> f64 {
    let distance = |angle| mean_distance(&turned(target, angle), reached);
    let step = TAU / TURNS as f64;
    let best = (0..TURNS)
        .map(|i| i as f64 * step)
        .min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
        .unwrap_or(0.0);
    let (mut low, mut high) = (best - step, best + step);
    for _ in 0..STEPS {
        let inset = (high - low) * (3.0 - 5f64.sqrt()) / 2.0;
        if distance(low + inset) < distance(high - inset) { high -= inset } else { low += inset }
    }
    (low + high) / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Translation3, UnitQuaternion};
    use seeone_core::Similarity;
    use seeone_core::frames::CanonicalObject;

    /// A bowl of four rings, its front pulled out.
    fn worn(round: bool) -> Worn {
        let vertices: Vec<_> = (0..48)
            .map(|i| {
                let (s, c) = (TAU * f64::from(i % 12) / 12.0).sin_cos();
                let ring = f64::from(i / 12) / 4.0;
                Point3::new(
                    -0.09 * s * (1.0 - ring),
                    (0.1 + 0.01 * c) * c * (1.0 - ring),
                    ring / 8.0,
                )
            })
            .collect();
        let canonical = CanonicalObject {
            name: "bowl".into(),
            vertices: Vec::new(),
            triangles: Vec::new(),
            edge_m: 1.0,
            round,
        };
        Worn { vertices, diameter_m: 0.2, canonical, canonical_to_head: Similarity::identity() }
    }

    fn reached(worn: &Worn, tilt: f64, yaw: f64, shift: f64) -> Vec<Point3<f64>> {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw)
            * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), tilt);
        let moved = Translation3::new(0.0, 0.0, shift);
        worn.vertices.iter().map(|v| moved * (turn * v)).collect()
    }

    #[test]
    fn a_shift_a_tilt_and_a_yaw_are_told_apart() {
        let worn = worn(false);
        let error = WearError::of(&worn, &reached(&worn, 0.0, 0.0, 0.01));
        assert!((error.mean_m - 0.01).abs() < 1e-12 && (error.mean_d - 0.05).abs() < 1e-12);
        assert!(error.tilt_deg < 1e-6 && error.yaw_deg.abs() < 1e-6);
        let error = WearError::of(&worn, &reached(&worn, 0.1, 0.0, 0.0));
        assert!((error.tilt_deg - 0.1f64.to_degrees()).abs() < 1e-6 && error.yaw_deg.abs() < 1e-6);
        let error = WearError::of(&worn, &reached(&worn, 0.0, -0.7, 0.0));
        assert!((error.yaw_deg + 0.7f64.to_degrees()).abs() < 1e-6 && error.tilt_deg < 1e-6);
        assert!(error.mean_d > 0.1);
    }

    #[test]
    fn a_round_object_may_be_turned_but_not_tilted_or_shifted() {
        let worn = worn(true);
        for yaw in [0.0, 0.03, 1.234, -2.9, std::f64::consts::PI] {
            let error = WearError::of(&worn, &reached(&worn, 0.0, yaw, 0.0));
            assert!(error.mean_m < 1e-6 && error.yaw_deg.abs() < 1e-3, "{yaw}: {error:?}");
            let error = WearError::of(&worn, &reached(&worn, 0.0, yaw, 0.01));
            assert!((error.mean_m - 0.01).abs() < 1e-6, "{yaw}: {error:?}");
            let error = WearError::of(&worn, &reached(&worn, 0.2, yaw, 0.0));
            assert!((error.tilt_deg - 0.2f64.to_degrees()).abs() < 1e-3, "{yaw}: {error:?}");
        }
    }
}
