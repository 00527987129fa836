#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::fakes::{LeastSquares, canonical_cloud};
use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use seeone_core::pose::difference;
use seeone_core::{Pose, Similarity};

fn placed() -> Similarity {
    let rotation = UnitQuaternion::from_scaled_axis(Vector3::new(0.5, -0.3, 1.2));
    Similarity::from_parts(Translation3::new(0.4, -0.2, 0.1), rotation, 0.28)
}

fn visor() -> Pose {
    Pose::new(Vector3::new(0.5, 0.95, 0.35), Vector3::new(-1.5, 0.1, 0.0))
}

#[test]
fn a_rigid_object_is_placed_exactly_and_back() {
    let cloud = canonical_cloud(&placed());
    let placement = Placement::new(&LeastSquares, &cloud).unwrap();
    assert!((placement.scale() - 0.28).abs() < 1e-9);
    let (tool, fit) = placement.push_forward(&visor()).unwrap();
    let expected = placed() * Point3::new(0.5, 0.95, 0.35);
    assert!((tool.translation.vector - expected.coords).norm() < 1e-9);
    assert!(fit.patch >= 8);
    let (distance, angle) = difference(&placement.pull_back(&tool).unwrap(), &visor());
    assert!(distance < 1e-9 && angle < 1e-6);
}

#[test]
fn a_bent_visor_carries_the_grasp_with_it() {
    // The visor is bent downward by 0.4 rad about the line where it meets the crown.
    let bend = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), -0.4);
    let hinge = Point3::new(0.5, 0.7, 0.35);
    let mut cloud = canonical_cloud(&placed());
    for (world, canonical) in cloud.points.iter_mut().zip(&cloud.nocs) {
        if canonical.y > 0.7 && canonical.z < 0.36 {
            *world = placed() * (hinge + bend * (canonical - hinge));
        }
    }
    let placement = Placement::new(&LeastSquares, &cloud).unwrap();
    let (tool, _) = placement.push_forward(&visor()).unwrap();
    let expected = placed() * (hinge + bend * (Point3::new(0.5, 0.95, 0.35) - hinge));
    let local = (tool.translation.vector - expected.coords).norm();
    let global = placement.global().transform * Point3::new(0.5, 0.95, 0.35);
    let global = (global - expected).norm();
    assert!(local < 0.004 && local < 0.5 * global, "local {local} m, global {global} m");
    let turned = placed().isometry.rotation * bend * visor().rotation;
    let angle = tool.rotation.angle_to(&turned);
    assert!(angle < 0.25, "{angle} rad of 0.4 are left");
}

#[test]
fn far_outliers_and_unseen_patches_do_not_carry_the_grasp_away() {
    let mut cloud = canonical_cloud(&placed());
    let near: Vec<usize> = (0..cloud.len())
        .filter(|i| (cloud.nocs[*i] - Point3::new(0.5, 0.95, 0.35)).norm() * 0.28 < 0.025)
        .collect();
    for i in near.iter().step_by(5) {
        cloud.points[*i] += Vector3::new(0.0, 0.0, 0.03);
    }
    let expected = (placed() * Point3::new(0.5, 0.95, 0.35)).coords;
    let placement = Placement::new(&LeastSquares, &cloud).unwrap();
    let (tool, _) = placement.push_forward(&visor()).unwrap();
    assert!((tool.translation.vector - expected).norm() < 0.004);

    let mut hidden = canonical_cloud(&placed());
    let keep: Vec<bool> = hidden.nocs.iter().map(|c| c.y < 0.5).collect();
    let mut kept = keep.iter();
    hidden.points.retain(|_| *kept.next().unwrap());
    let mut kept = keep.iter();
    hidden.nocs.retain(|_| *kept.next().unwrap());
    hidden.confidence.truncate(hidden.nocs.len());
    let placement = Placement::new(&LeastSquares, &hidden).unwrap();
    let (tool, fit) = placement.push_forward(&visor()).unwrap();
    assert_eq!(fit.patch, 0);
    assert!((tool.translation.vector - expected).norm() < 1e-6);
}

#[test]
fn too_few_points_are_refused() {
    let mut cloud = canonical_cloud(&placed());
    cloud.points.truncate(2);
    cloud.nocs.truncate(2);
    cloud.confidence.truncate(2);
    assert!(Placement::new(&LeastSquares, &cloud).is_err());
}
