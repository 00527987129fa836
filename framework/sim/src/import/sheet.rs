//! A triangle mesh while it is being worked on, and what its edges say about it.

use super::ImportFault;
use nalgebra::{Point3, Vector3};
use seeone_core::TriangleMesh;
use std::collections::BTreeMap;

/// Vertices and triangles; indices are in range, nothing else is promised.
#[derive(Clone, Debug)]
pub struct Sheet {
    pub vertices: Vec<Point3<f64>>,
    pub triangles: Vec<[u32; 3]>,
}

/// An edge by its vertices, the smaller index first.
pub type Edge = (u32, u32);

/// The edge between two vertices.
pub fn edge(a: u32, b: u32) -> Edge {
    (a.min(b), a.max(b))
}

/// The three edges of a triangle.
pub fn edges_of(t: &[u32; 3]) -> [Edge; 3] {
    [edge(t[0], t[1]), edge(t[1], t[2]), edge(t[2], t[0])]
}

impl Sheet {
    /// Every edge with the triangles at it, in the order of its vertices.
    pub fn edges(&self) -> BTreeMap<Edge, Vec<usize>> {
        let mut edges: BTreeMap<Edge, Vec<usize>> = BTreeMap::new();
        for (i, t) in self.triangles.iter().enumerate() {
            for e in edges_of(t) {
                edges.entry(e).or_default().push(i);
            }
        }
        edges
    }

    /// Corners of a triangle.
    pub fn corners(&self, triangle: usize) -> [Point3<f64>; 3] {
        self.triangles[triangle].map(|v| self.vertices[v as usize])
    }

    /// Normal of a triangle, twice its area long.
    pub fn normal(&self, triangle: usize) -> Vector3<f64> {
        let [a, b, c] = self.corners(triangle);
        (b - a).cross(&(c - a))
    }

    /// Middle of a triangle.
    pub fn centre(&self, triangle: usize) -> Point3<f64> {
        let [a, b, c] = self.corners(triangle);
        Point3::from((a.coords + b.coords + c.coords) / 3.0)
    }

    /// Length of an edge.
    pub fn length(&self, (a, b): Edge) -> f64 {
        (self.vertices[a as usize] - self.vertices[b as usize]).norm()
    }

    /// Smallest and largest coordinates of the vertices that triangles use.
    pub fn bounds(&self) -> (Point3<f64>, Point3<f64>) {
        let infinite = Vector3::repeat(f64::INFINITY);
        let used = self.triangles.iter().flatten().map(|v| &self.vertices[*v as usize]);
        used.fold((Point3::from(infinite), Point3::from(-infinite)), |(low, high), v| {
            (low.inf(v), high.sup(v))
        })
    }

    /// The finished mesh.
    pub fn into_mesh(self) -> Result<TriangleMesh, ImportFault> {
        TriangleMesh::new(self.vertices, self.triangles).map_err(|_| ImportFault::NoFaces)
    }
}
