//! Triangle meshes.

use nalgebra::{Point3, Vector3};

/// A triangle mesh whose every index is in range and whose every coordinate is finite.
#[derive(Clone, Debug, PartialEq)]
pub struct TriangleMesh {
    vertices: Vec<Point3<f64>>,
    triangles: Vec<[u32; 3]>,
}

/// Why vertices and triangles do not make a mesh.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MeshFault {
    /// There is no triangle at all.
    #[error("the mesh has no faces")]
    NoFaces,
    /// A vertex is NaN or infinite.
    #[error("vertex {0} is not finite")]
    NotFinite(usize),
    /// A triangle names a vertex that is not there.
    #[error("face {0} names vertex {1}, but there are only {2} vertices")]
    OutOfRange(usize, u32, usize),
    /// A triangle names one vertex twice.
    #[error("face {0} names one vertex twice")]
    Degenerate(usize),
}

impl TriangleMesh {
    /// Checks and takes vertices and triangles.
    ///
    /// # Errors
    /// The first fault found.
    pub fn new(vertices: Vec<Point3<f64>>, triangles: Vec<[u32; 3]>) -> Result<Self, MeshFault> {
        if triangles.is_empty() {
            return Err(MeshFault::NoFaces);
        }
        if let Some(i) = vertices.iter().position(|v| !v.coords.iter().all(|c| c.is_finite())) {
            return Err(MeshFault::NotFinite(i));
        }
        for (i, t) in triangles.iter().enumerate() {
            if let Some(v) = t.iter().find(|v| **v as usize >= vertices.len()) {
                return Err(MeshFault::OutOfRange(i, *v, vertices.len()));
            }
            if t[0] == t[1] || t[1] == t[2] || t[0] == t[2] {
                return Err(MeshFault::Degenerate(i));
            }
        }
        Ok(Self { vertices, triangles })
    }

    /// Vertex positions.
    pub fn vertices(&self) -> &[Point3<f64>] {
        &self.vertices
    }

    /// Vertex indices of each triangle, counter-clockwise seen from outside.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The corners of triangle `index`.
    pub fn corners(&self, index: usize) -> [Point3<f64>; 3] {
        self.triangles[index].map(|v| self.vertices[v as usize])
    }

    /// The same triangles over other vertex positions (a deformed copy).
    ///
    /// # Errors
    /// [`MeshFault::NotFinite`], or [`MeshFault::OutOfRange`] when vertices are missing.
    pub fn with_vertices(&self, vertices: Vec<Point3<f64>>) -> Result<Self, MeshFault> {
        Self::new(vertices, self.triangles.clone())
    }

    /// Smallest and largest coordinate along each axis.
    pub fn bounds(&self) -> (Point3<f64>, Point3<f64>) {
        let mut low = Point3::from(Vector3::repeat(f64::INFINITY));
        let mut high = Point3::from(Vector3::repeat(f64::NEG_INFINITY));
        for v in &self.vertices {
            low = low.inf(v);
            high = high.sup(v);
        }
        (low, high)
    }

    /// The largest distance between two vertices: the object's diameter `d` when the mesh
    /// is in its canonical state (method: metrics).
    pub fn diameter(&self) -> f64 {
        let mut largest: f64 = 0.0;
        for (i, a) in self.vertices.iter().enumerate() {
            for b in &self.vertices[i + 1..] {
                largest = largest.max((a - b).norm_squared());
            }
        }
        largest.sqrt()
    }
}
