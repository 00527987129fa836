//! Points of a shell between its vertices.

use crate::shell::{Shell, topology};
use nalgebra::{Point3, Vector3};

/// A point of the shell between its vertices, for bodies thinner than a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Vertices it hangs on.
    pub vertices: [usize; 3],
    /// Barycentric weights, summing to one.
    pub weights: [f64; 3],
}

impl Sample {
    /// Every vertex, edge midpoint and triangle centroid of `triangles`.
    pub fn all(triangles: &[[u32; 3]], vertex_count: usize) -> Vec<Self> {
        let vertices =
            (0..vertex_count).map(|v| Self { vertices: [v; 3], weights: [1.0, 0.0, 0.0] });
        let midpoints = topology::edges(triangles).into_iter().map(|e| Self {
            vertices: [e.ends[0], e.ends[1], e.ends[1]],
            weights: [0.5, 0.5, 0.0],
        });
        let centroids = triangles
            .iter()
            .map(|t| Self { vertices: t.map(|v| v as usize), weights: [1.0 / 3.0; 3] });
        vertices.chain(midpoints).chain(centroids).collect()
    }

    /// Whether it is a vertex.
    pub fn is_vertex(&self) -> bool {
        self.vertices[0] == self.vertices[1]
    }

    /// The vertices that carry it, with their weights.
    pub fn carriers(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.vertices.iter().copied().zip(self.weights).filter(|(_, b)| *b > 0.0)
    }

    /// Where it is, given the vertices' positions.
    #[inline]
    pub fn at(&self, position: &[Point3<f64>]) -> Point3<f64> {
        let sum: Vector3<f64> = self.carriers().map(|(v, b)| position[v].coords * b).sum();
        Point3::from(sum)
    }

    /// Its generalised inverse mass, 1/kg; zero when no vertex of it is free.
    #[inline]
    pub fn inverse_mass(&self, shell: &Shell) -> f64 {
        self.carriers().map(|(v, b)| shell.inverse_mass[v] * b * b).sum()
    }

    /// Moves it by `correction`, if any of its vertices is free.
    #[inline]
    pub fn shift(&self, shell: &mut Shell, correction: &Vector3<f64>) {
        let inverse = self.inverse_mass(shell);
        if inverse > 0.0 {
            for (v, b) in self.carriers() {
                shell.position[v] += correction * (shell.inverse_mass[v] * b / inverse);
            }
        }
    }
}
