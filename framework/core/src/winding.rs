//! The generalised winding number of a triangle mesh (Jacobson et al. 2013): by how much
//! of the full sphere of directions the surface surrounds a point.
//!
//! One inside a closed mesh and zero outside; between the two near the opening of an open
//! one, which is why it serves as the occupancy of a cap (paper, Eq. 4). Exact: a sum of
//! the triangles' solid angles (van Oosterom and Strackee 1983), without a tree.

use crate::TriangleMesh;
use nalgebra::{Point3, Vector3};

/// Below this length (in the mesh's unit) a point is taken to lie on a corner, where the
/// solid angle of a triangle has no value; the triangle then counts nothing.
const ON_CORNER: f64 = 1e-12;

/// The winding number of `mesh` about `point`: positive inside where triangles run
/// counter-clockwise seen from outside. Time is linear in the number of triangles.
pub fn winding_number(mesh: &TriangleMesh, point: &Point3<f64>) -> f64 {
    // A vertex is a corner of about six triangles: its distance is taken once.
    let seen: Vec<(Vector3<f64>, f64)> = mesh
        .vertices()
        .iter()
        .map(|vertex| {
            let direction = vertex - point;
            (direction, direction.norm())
        })
        .collect();
    let angle = |t: &[u32; 3]| solid_angle(t.map(|v| seen[v as usize]));
    mesh.triangles().iter().map(angle).sum::<f64>() / (4.0 * std::f64::consts::PI)
}

/// The signed solid angle in steradians of the triangle with these corners (each with its
/// distance), seen from the origin:
/// tan(angle / 2) = det[a b c] / (abc + (a.b)c + (b.c)a + (c.a)b).
fn solid_angle([(a, la), (b, lb), (c, lc)]: [(Vector3<f64>, f64); 3]) -> f64 {
    if la.min(lb).min(lc) < ON_CORNER {
        return 0.0;
    }
    let numerator = a.dot(&b.cross(&c));
    let denominator = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
    2.0 * numerator.atan2(denominator)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The unit cube, `faces` of its twelve triangles, outward.
    fn cube(faces: usize) -> TriangleMesh {
        let vertices = (0..8u8)
            .map(|i| Point3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)))
            .collect();
        let triangles = [
            [0, 2, 1],
            [1, 2, 3],
            [0, 1, 4],
            [1, 5, 4],
            [0, 4, 2],
            [2, 4, 6], //
            [1, 3, 5],
            [3, 7, 5],
            [2, 6, 3],
            [3, 6, 7],
            [4, 5, 6],
            [5, 7, 6], // last two: top
        ];
        TriangleMesh::new(vertices, triangles[..faces].to_vec()).expect("a mesh")
    }

    #[test]
    fn is_one_inside_and_zero_outside_a_closed_mesh() {
        let mesh = cube(12);
        for inside in [[0.5, 0.5, 0.5], [0.01, 0.9, 0.3], [0.999, 0.999, 0.999]] {
            assert!((winding_number(&mesh, &inside.into()) - 1.0).abs() < 1e-9, "{inside:?}");
        }
        for outside in [[1.5, 0.5, 0.5], [-0.01, 0.9, 0.3], [4.0, -3.0, 9.0]] {
            assert!(winding_number(&mesh, &outside.into()).abs() < 1e-9, "{outside:?}");
        }
    }

    #[test]
    fn an_open_mesh_lacks_what_its_opening_would_cover() {
        let open = cube(10);
        // Seen from the centre each of the six faces covers a sixth.
        let centre = winding_number(&open, &Point3::new(0.5, 0.5, 0.5));
        assert!((centre - 5.0 / 6.0).abs() < 1e-9, "{centre}");
        // In the middle of the missing face half of everything is open.
        let rim = winding_number(&open, &Point3::new(0.5, 0.5, 1.0));
        assert!((rim - 0.5).abs() < 1e-9, "{rim}");
    }

    #[test]
    fn turns_its_sign_with_the_triangles_and_has_a_value_on_a_corner() {
        let mesh = cube(12);
        let flipped = mesh.triangles().iter().map(|t| [t[0], t[2], t[1]]).collect();
        let flipped = TriangleMesh::new(mesh.vertices().to_vec(), flipped).expect("a mesh");
        let inside = Point3::new(0.3, 0.6, 0.2);
        assert!((winding_number(&flipped, &inside) + 1.0).abs() < 1e-9);
        assert!(winding_number(&mesh, &Point3::origin()).is_finite());
    }
}
