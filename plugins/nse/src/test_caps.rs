//! Caps made of half an ellipsoid and a visor, for tests.

use nalgebra::Point3;
use seeone_core::TriangleMesh;

/// Segments around the crown.
const AROUND: usize = 24;
/// Rings of the crown.
const RINGS: usize = 8;

/// A canonical cap whose crown is `0.5 + growth` units high: z up, visor along +y, open
/// below, bounding box centred in the unit cube, longest edge 1.
pub(crate) fn cap(growth: f64) -> TriangleMesh {
    let mut vertices = vec![Point3::new(0.0, 0.0, 0.5 + growth)];
    let mut triangles = Vec::new();
    let at = |ring: usize, i: usize| (1 + (ring - 1) * AROUND + i % AROUND) as u32;
    for ring in 1..=RINGS {
        let polar = std::f64::consts::FRAC_PI_2 * ring as f64 / RINGS as f64;
        for i in 0..AROUND {
            let angle = std::f64::consts::TAU * i as f64 / AROUND as f64;
            let (radius, height) = (0.33 * polar.sin(), (0.5 + growth) * polar.cos());
            vertices.push(Point3::new(radius * angle.cos(), radius * angle.sin(), height));
        }
        for i in 0..AROUND {
            if ring == 1 {
                triangles.push([0, at(1, i), at(1, i + 1)]);
            } else {
                let (a, b, c, d) =
                    (at(ring - 1, i), at(ring, i), at(ring, i + 1), at(ring - 1, i + 1));
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    // The visor: the front sixth of the rim, drawn forward.
    let front: Vec<usize> = (AROUND / 6..=AROUND / 3).collect();
    let first = vertices.len() as u32;
    for i in &front {
        let rim = vertices[at(RINGS, *i) as usize];
        vertices.push(Point3::new(rim.x, rim.y + 0.3, -0.05));
    }
    for (k, i) in front.iter().enumerate().take(front.len() - 1) {
        let (a, b) = (at(RINGS, *i), at(RINGS, i + 1));
        let (c, d) = (first + k as u32, first + k as u32 + 1);
        triangles.extend([[a, c, d], [a, d, b]]);
    }
    let mesh = TriangleMesh::new(vertices, triangles).expect("a mesh");
    let (low, high) = mesh.bounds();
    let edge = (high - low).max();
    let centre = nalgebra::center(&low, &high);
    let cube = |p: &Point3<f64>| Point3::from((p - centre) / edge).map(|v| v + 0.5);
    mesh.with_vertices(mesh.vertices().iter().map(cube).collect()).expect("a mesh")
}
