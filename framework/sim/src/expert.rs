//! The scripted expert of `teach`: it knows the true mesh and grasps the visor's front
//! edge. Nothing outside `teach` may ask it.

use crate::object::{Object, Region};
use crate::rigid_fit::rigid_fit;
use nalgebra::{Matrix3, Point3, Vector3};
use seeone_core::Pose;
use seeone_core::pose::rotation_from_approach;

/// The tool frame lies this far inside the visor's edge: with tips 10 mm further, the
/// pads cover some 20 mm of the visor, metres.
const INSIDE_M: f64 = 0.012;
/// Vertices within this distance of the tip tell how the visor lies there, metres.
const PATCH_M: f64 = 0.035;
/// The tip is looked for this near to the plane of symmetry, metres.
const MIDDLE_M: f64 = 0.015;

/// The visor's front edge on one object, and the grasp that belongs to it.
#[derive(Clone, Debug)]
pub struct VisorGrasp {
    patch: Vec<usize>,
    rest: Vec<Point3<f64>>,
    tool: Pose,
}

impl VisorGrasp {
    /// The grasp of this object, whose hand comes from above the visor's plane by
    /// `pitch_rad`; `None` when the object has no visor.
    pub fn of(object: &Object, pitch_rad: f64) -> Option<Self> {
        let vertices = object.mesh().vertices();
        let brim = object.vertices_of(Region::Brim);
        let tip = brim
            .iter()
            .map(|v| vertices[*v])
            .filter(|p| p.x.abs() < MIDDLE_M)
            .max_by(|a, b| a.y.total_cmp(&b.y))?;
        let patch: Vec<usize> =
            brim.into_iter().filter(|v| (vertices[*v] - tip).norm() < PATCH_M).collect();
        let rest: Vec<_> = patch.iter().map(|v| vertices[*v]).collect();
        let normal = plane_normal(&rest)?;
        let inward = (-Vector3::y() + normal * normal.y).normalize();
        let approach = inward * pitch_rad.cos() - normal * pitch_rad.sin();
        let rotation = rotation_from_approach(&approach, &normal);
        let tool = Pose::from_parts((tip + inward * INSIDE_M).into(), rotation);
        Some(Self { patch, rest, tool })
    }

    /// The tool's pose on the object as its `vertices` are now, in their frame.
    pub fn tool_on(&self, vertices: &[Point3<f64>]) -> Pose {
        let now: Vec<_> = self.patch.iter().map(|v| vertices[*v]).collect();
        rigid_fit(&self.rest, &now) * self.tool
    }
}

/// Upward normal of the plane through `points`.
fn plane_normal(points: &[Point3<f64>]) -> Option<Vector3<f64>> {
    if points.len() < 3 {
        return None;
    }
    let mean: Vector3<f64> =
        points.iter().map(|p| p.coords).sum::<Vector3<f64>>() / points.len() as f64;
    let scatter: Matrix3<f64> =
        points.iter().map(|p| (p.coords - mean) * (p.coords - mean).transpose()).sum();
    let eigen = scatter.symmetric_eigen();
    let normal: Vector3<f64> = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into();
    Some(if normal.z < 0.0 { -normal } else { normal })
}
