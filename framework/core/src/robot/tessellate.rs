//! Triangles for the simple bodies.

use super::Shape;
use crate::{Pose, TriangleMesh};
use nalgebra::{Point3, Vector3};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Corners of a circle.
const SIDES: u32 = 20;
/// Rings of a half ball, the pole not counted.
const RINGS: u32 = 4;

/// The surface of `shape` centred at `pose`, outward, vertices in `pose`'s parent frame.
pub(super) fn tessellate(shape: &Shape, pose: &Pose) -> TriangleMesh {
    let (vertices, triangles) = match *shape {
        Shape::Box { half_m } => cuboid(&half_m),
        Shape::Cylinder { radius_m, length_m } => revolve(&[
            (0.0, -0.5 * length_m),
            (radius_m, -0.5 * length_m),
            (radius_m, 0.5 * length_m),
            (0.0, 0.5 * length_m),
        ]),
        Shape::Capsule { radius_m, length_m } => revolve(&half_balls(radius_m, length_m)),
        Shape::Sphere { radius_m } => revolve(&half_balls(radius_m, 0.0)),
    };
    let placed = vertices.iter().map(|v| pose * v).collect();
    TriangleMesh::new(placed, triangles).expect("a checked shape has a finite, closed surface")
}

type Faces = (Vec<Point3<f64>>, Vec<[u32; 3]>);

fn cuboid(half: &Vector3<f64>) -> Faces {
    let sign = |i: u32, bit: u32| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
    let vertices = (0..8)
        .map(|i| Point3::new(sign(i, 0) * half.x, sign(i, 1) * half.y, sign(i, 2) * half.z))
        .collect();
    let quads: [[u32; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = quads.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    (vertices, triangles)
}

/// The outline `(radius, z)` of a capsule from pole to pole.
fn half_balls(radius: f64, length: f64) -> Vec<(f64, f64)> {
    let arc = |k: u32| FRAC_PI_2 * f64::from(k) / f64::from(RINGS);
    let low = (0..=RINGS).map(|k| {
        let (sin, cos) = arc(k).sin_cos();
        (radius * sin, -0.5 * length - radius * cos)
    });
    let high = (0..=RINGS).map(|k| {
        let (sin, cos) = arc(k).sin_cos();
        (radius * cos, 0.5 * length + radius * sin)
    });
    // The last ring of one half is the first of the other where there is no cylinder.
    low.chain(high.skip(usize::from(length == 0.0))).collect()
}

/// The surface of revolution of an outline that starts and ends on the z axis.
fn revolve(outline: &[(f64, f64)]) -> Faces {
    let inner = &outline[1..outline.len() - 1];
    let mut vertices = vec![Point3::new(0.0, 0.0, outline[0].1)];
    for (radius, z) in inner {
        vertices.extend((0..SIDES).map(|k| {
            let (sin, cos) = (TAU * f64::from(k) / f64::from(SIDES)).sin_cos();
            Point3::new(radius * cos, radius * sin, *z)
        }));
    }
    let top = vertices.len() as u32;
    vertices.push(Point3::new(0.0, 0.0, outline[outline.len() - 1].1));
    let at = |ring: u32, k: u32| 1 + ring * SIDES + k % SIDES;
    let rings = inner.len() as u32;
    let mut triangles = Vec::new();
    for k in 0..SIDES {
        triangles.push([0, at(0, k + 1), at(0, k)]);
        for ring in 0..rings - 1 {
            triangles.push([at(ring, k), at(ring, k + 1), at(ring + 1, k + 1)]);
            triangles.push([at(ring, k), at(ring + 1, k + 1), at(ring + 1, k)]);
        }
        triangles.push([at(rings - 1, k), at(rings - 1, k + 1), top]);
    }
    (vertices, triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::winding::Exact;

    #[test]
    fn every_shape_is_closed_and_faces_outward() {
        let pose = Pose::new(Vector3::new(0.3, -0.2, 0.5), Vector3::new(0.4, 1.0, -0.7));
        let shapes = [
            (Shape::Box { half_m: Vector3::new(0.1, 0.2, 0.3) }, 0.3),
            (Shape::Cylinder { radius_m: 0.1, length_m: 0.4 }, 0.2),
            (Shape::Capsule { radius_m: 0.1, length_m: 0.4 }, 0.3),
            (Shape::Sphere { radius_m: 0.1 }, 0.1),
        ];
        for (shape, end) in shapes {
            let mesh = tessellate(&shape, &pose);
            for (z, inside) in
                [(0.0, 1.0), (0.98 * end, 1.0), (-0.98 * end, 1.0), (1.02 * end, 0.0)]
            {
                let at = pose * Point3::new(0.0, 0.0, z);
                let number = Exact::new(&mesh).at(&at);
                assert!((number - inside).abs() < 1e-6, "{shape:?} at {z}: {number}");
            }
        }
    }
}
