//! Meshes of what does not move: the table and the mat on it, a head.

use crate::surroundings::HEAD_SEMI_AXES_M;
use nalgebra::{Point3, Vector3};
use seeone_core::{Pose, TriangleMesh};

/// A rectangle in the plane `z = height`, centred at `centre`, facing up.
pub fn rectangle(centre: [f64; 2], size: [f64; 2], height: f64) -> TriangleMesh {
    let corner = |x: f64, y: f64| {
        Point3::new(centre[0] + 0.5 * x * size[0], centre[1] + 0.5 * y * size[1], height)
    };
    let corners = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    TriangleMesh::new(corners, vec![[0, 1, 2], [0, 2, 3]]).expect("two whole triangles")
}

/// The table top, `z = 0` in `world`.
pub fn table() -> TriangleMesh {
    rectangle([0.0, 0.0], [3.0, 3.0], 0.0)
}

/// The head's ellipsoid with its frame at `pose` in `world`.
pub fn head(pose: &Pose) -> TriangleMesh {
    ellipsoid(&HEAD_SEMI_AXES_M.into(), pose)
}

/// An ellipsoid of these semi-axes (metres) about `pose`.
pub fn ellipsoid(semi_axes_m: &Vector3<f64>, pose: &Pose) -> TriangleMesh {
    const AROUND: u32 = 48;
    const DOWN: u32 = 24;
    let mut vertices = Vec::new();
    for i in 0..=DOWN {
        let (sin_i, cos_i) = (std::f64::consts::PI * f64::from(i) / f64::from(DOWN)).sin_cos();
        for j in 0..AROUND {
            let (sin_j, cos_j) =
                (std::f64::consts::TAU * f64::from(j) / f64::from(AROUND)).sin_cos();
            let unit = Vector3::new(sin_i * cos_j, sin_i * sin_j, cos_i);
            vertices.push(pose * Point3::from(unit.component_mul(semi_axes_m)));
        }
    }
    let vertex = |i: u32, j: u32| i * AROUND + j % AROUND;
    let triangles = (0..DOWN)
        .flat_map(|i| (0..AROUND).map(move |j| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b] = [vertex(i, j), vertex(i, j + 1)];
            let [c, d] = [vertex(i + 1, j), vertex(i + 1, j + 1)];
            [[a, c, d], [a, d, b]]
        })
        .collect();
    TriangleMesh::new(vertices, triangles).expect("every index lies in the grid")
}
