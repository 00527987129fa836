//! Smooth normals that keep sharp creases sharp.

use crate::raster::Hit;
use nalgebra::Vector3;
use seeone_core::TriangleMesh;

/// Faces that meet at a larger angle keep a sharp edge, radians.
const CREASE_RAD: f64 = 0.7;

/// One normal for every corner of every triangle.
pub struct Surface {
    normals: Vec<[Vector3<f64>; 3]>,
}

impl Surface {
    /// At each corner the area-weighted mean of the faces around its vertex that lie
    /// within the crease angle of the corner's own face.
    pub fn new(mesh: &TriangleMesh) -> Self {
        let faces: Vec<Vector3<f64>> = (0..mesh.triangles().len())
            .map(|i| {
                let [a, b, c] = mesh.corners(i);
                (b - a).cross(&(c - a))
            })
            .collect();
        let mut around = vec![Vec::new(); mesh.vertices().len()];
        for (i, triangle) in mesh.triangles().iter().enumerate() {
            for v in triangle {
                around[*v as usize].push(i);
            }
        }
        let smooth = |own: &Vector3<f64>, vertex: u32| {
            let limit = CREASE_RAD.cos() * own.norm();
            around[vertex as usize]
                .iter()
                .map(|f| &faces[*f])
                .filter(|f| f.dot(own) >= limit * f.norm())
                .sum::<Vector3<f64>>()
        };
        let normals = mesh
            .triangles()
            .iter()
            .zip(&faces)
            .map(|(t, own)| t.map(|v| smooth(own, v).try_normalize(0.0).unwrap_or(*own)))
            .collect();
        Self { normals }
    }

    /// The unit normal at `hit` on the side from which `view` (towards the eye) looks, and
    /// whether that side is the outside.
    pub fn normal_towards(&self, hit: &Hit, view: &Vector3<f64>) -> (Vector3<f64>, bool) {
        let normal = hit.interpolate(self.normals[hit.triangle as usize]);
        let normal = normal.try_normalize(0.0).unwrap_or_else(Vector3::z);
        let outside = normal.dot(view) >= 0.0;
        (if outside { normal } else { -normal }, outside)
    }
}
