use super::Exact;
use crate::TriangleMesh;
use crate::random::{Generator, direction, generator, uniform};
use nalgebra::{Point3, Vector3};
use std::f64::consts::PI;

/// The sum of the triangles' solid angles (van Oosterom and Strackee 1983):
/// tan(angle / 2) = det[a b c] / (abc + (a.b)c + (b.c)a + (c.a)b).
fn sum_of_solid_angles(mesh: &TriangleMesh, point: &Point3<f64>) -> f64 {
    let angle = |index: usize| {
        let [a, b, c] = mesh.corners(index).map(|corner| corner - point);
        let (la, lb, lc) = (a.norm(), b.norm(), c.norm());
        let numerator = a.dot(&b.cross(&c));
        let denominator = la * lb * lc + a.dot(&b) * lc + b.dot(&c) * la + c.dot(&a) * lb;
        2.0 * numerator.atan2(denominator)
    };
    (0..mesh.triangles().len()).map(angle).sum::<f64>() / (4.0 * PI)
}

fn mesh(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> TriangleMesh {
    let vertices = vertices.iter().map(|v| Point3::from(*v)).collect();
    TriangleMesh::new(vertices, triangles.to_vec()).expect("a mesh")
}

/// The unit cube, the first `faces` of its twelve triangles, outward; the last two are
/// its lid.
fn cube(faces: usize) -> TriangleMesh {
    let corner = |i: u8| [i & 1, i >> 1 & 1, i >> 2].map(f64::from);
    let triangles = [
        [0, 2, 1],
        [1, 2, 3],
        [0, 1, 4],
        [1, 5, 4],
        [0, 4, 2],
        [2, 4, 6],
        [1, 3, 5],
        [3, 7, 5],
        [2, 6, 3],
        [3, 6, 7],
        [4, 5, 6],
        [5, 7, 6],
    ];
    mesh(&(0..8).map(corner).collect::<Vec<_>>(), &triangles[..faces])
}

/// A bumpy dome of radius one with a hole at the back: rings and spokes about +z from the
/// apex to the rim, some triangles left out.
fn dome(rings: u32, spokes: u32) -> TriangleMesh {
    let mut vertices = vec![[0.0, 0.0, 1.0]];
    for (ring, spoke) in (1..=rings).flat_map(|r| (0..spokes).map(move |s| (r, s))) {
        let down = 0.6 * PI * f64::from(ring) / f64::from(rings);
        let around = 2.0 * PI * f64::from(spoke) / f64::from(spokes);
        let radius = 1.0 + 0.05 * (3.0 * around).sin() * down;
        vertices.push([
            radius * down.sin() * around.cos(),
            radius * down.sin() * around.sin(),
            radius * down.cos(),
        ]);
    }
    let at = |ring: u32, spoke: u32| 1 + (ring - 1) * spokes + spoke % spokes;
    let mut triangles: Vec<[u32; 3]> = (0..spokes).map(|s| [0, at(1, s), at(1, s + 1)]).collect();
    for (r, s) in (1..rings).flat_map(|r| (0..spokes).map(move |s| (r, s))) {
        if r + 2 == rings && s < 2 {
            continue;
        }
        triangles.push([at(r, s), at(r + 1, s), at(r + 1, s + 1)]);
        triangles.push([at(r, s), at(r + 1, s + 1), at(r, s + 1)]);
    }
    mesh(&vertices, &triangles)
}

/// Three pages of a book: they meet at one edge, which none of them closes.
fn book() -> TriangleMesh {
    let page = |angle: f64| [angle.cos(), angle.sin()];
    let mut vertices = vec![[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
    let mut triangles = Vec::new();
    for (i, angle) in [0.0, 2.0, 3.5].into_iter().enumerate() {
        let [x, y] = page(angle);
        vertices.extend([[x, y, 0.1], [x, y, 1.2]]);
        let [low, high] = [2 + 2 * i as u32, 3 + 2 * i as u32];
        triangles.extend([[0, low, high], [0, high, 1]]);
    }
    mesh(&vertices, &triangles)
}

fn tilted(mesh: &TriangleMesh) -> TriangleMesh {
    let turn = nalgebra::Rotation3::from_euler_angles(0.7, -1.1, 2.3);
    mesh.with_vertices(mesh.vertices().iter().map(|v| turn * v).collect()).expect("a mesh")
}

/// Every kind of mesh the tests know, also tilted out of the axes.
fn meshes() -> Vec<TriangleMesh> {
    let upright = [cube(12), cube(10), cube(7), dome(7, 12), dome(9, 31), book()];
    let tilted: Vec<_> = upright.iter().map(tilted).collect();
    upright.into_iter().chain(tilted).collect()
}

/// Points about the mesh, near its surface and far away.
fn points(mesh: &TriangleMesh, rng: &mut Generator) -> Vec<Point3<f64>> {
    let mut points = Vec::new();
    for i in 0..300 {
        points.push(Point3::from(Vector3::from_fn(|_, _| uniform(rng, -1.5, 1.5))));
        points.push(Point3::from(direction(rng) * 10f64.powf(uniform(rng, 0.0, 4.0))));
        let [a, b, c] = mesh.corners(i % mesh.triangles().len());
        let (u, v) = (uniform(rng, 0.05, 0.45), uniform(rng, 0.05, 0.45));
        let on = a + (b - a) * u + (c - a) * v;
        points
            .push(on + (b - a).cross(&(c - a)).normalize() * 10f64.powf(uniform(rng, -8.0, -1.0)));
    }
    points
}

#[track_caller]
fn assert_agrees(winding: &Exact, point: &Point3<f64>) {
    let (found, truth) = (winding.at(point), sum_of_solid_angles(winding.mesh, point));
    assert!((found - truth).abs() < 1e-9, "at {point}: {found}, not {truth}");
}

#[test]
fn agrees_with_the_sum_of_solid_angles_near_the_surface_and_far_away() {
    for mesh in meshes() {
        let winding = Exact::new(&mesh);
        for point in points(&mesh, &mut generator(1, "winding")) {
            assert_agrees(&winding, &point);
        }
    }
}

#[test]
fn agrees_in_the_columns_of_vertices_and_edges() {
    for mesh in meshes() {
        let winding = Exact::new(&mesh);
        let triangles: Vec<_> = (0..mesh.triangles().len()).map(|i| mesh.corners(i)).collect();
        let (mut compared, mut on_the_surface) = (0, 0);
        for [a, b, c] in &triangles {
            for place in [*a, nalgebra::center(a, b), nalgebra::center(b, c)] {
                for (nudge, height) in [(0.0, -3.0), (0.0, 0.23), (1e-17, 0.61), (-1e-16, -0.37)] {
                    let point = Point3::new(place.x + nudge, place.y - nudge, height);
                    // So near to the surface the reference itself is in doubt.
                    if triangles.iter().any(|t| distance(t, &point) < 1e-6) {
                        on_the_surface += 1;
                    } else {
                        assert_agrees(&winding, &point);
                        compared += 1;
                    }
                }
            }
        }
        assert!(2 * compared > on_the_surface, "{compared} compared, {on_the_surface} left out");
    }
}

/// Distance of `point` from the triangle of these corners.
fn distance(corners: &[Point3<f64>; 3], point: &Point3<f64>) -> f64 {
    let [a, b, c] = corners;
    let normal = (b - a).cross(&(c - a)).normalize();
    let flat = point - normal * normal.dot(&(point - a));
    let inside = |p: &Point3<f64>, q: &Point3<f64>| (q - p).cross(&(flat - p)).dot(&normal) >= 0.0;
    if inside(a, b) && inside(b, c) && inside(c, a) {
        return (flat - point).norm();
    }
    let to_edge = |p: &Point3<f64>, q: &Point3<f64>| {
        let along = ((point - p).dot(&(q - p)) / (q - p).norm_squared()).clamp(0.0, 1.0);
        (p + (q - p) * along - point).norm()
    };
    to_edge(a, b).min(to_edge(b, c)).min(to_edge(c, a))
}

#[test]
fn is_whole_inside_and_outside_a_closed_mesh() {
    for mesh in [cube(12), tilted(&cube(12))] {
        let inside = Exact::new(&mesh).at(&nalgebra::center(&mesh.bounds().0, &mesh.bounds().1));
        let outside = Exact::new(&mesh).at(&Point3::new(1.5, 1.5, 0.5));
        assert_eq!([inside, outside], [1.0, 0.0]);
    }
}

#[test]
fn an_open_mesh_lacks_what_its_opening_would_cover() {
    let open = cube(10);
    let winding = Exact::new(&open);
    // Seen from the centre each of the six faces covers a sixth.
    let centre = winding.at(&Point3::new(0.5, 0.5, 0.5));
    assert!((centre - 5.0 / 6.0).abs() < 1e-12, "{centre}");
    // In the middle of the missing face half of everything is open.
    let rim = winding.at(&Point3::new(0.5, 0.5, 1.0));
    assert!((rim - 0.5).abs() < 1e-12, "{rim}");
}

#[test]
fn turns_its_sign_with_the_triangles_and_is_finite_on_the_surface() {
    for mesh in meshes() {
        let flipped = mesh.triangles().iter().map(|t| [t[0], t[2], t[1]]).collect();
        let flipped = TriangleMesh::new(mesh.vertices().to_vec(), flipped).expect("a mesh");
        let point = Point3::new(0.31, 0.62, 0.23);
        let both = Exact::new(&mesh).at(&point) + Exact::new(&flipped).at(&point);
        assert!(both.abs() < 1e-12, "{both}");
        for corner in mesh.vertices() {
            assert!(Exact::new(&mesh).at(corner).is_finite());
        }
    }
}

#[test]
fn a_grid_holds_the_same_numbers_along_z_first() {
    // A step of a quarter: columns through the cube's walls and over the dome's apex.
    let (low, step, counts) = (Point3::new(-1.0, -1.25, -0.75), 0.25, [9, 10, 21]);
    for mesh in [cube(10), dome(7, 12), book()] {
        let winding = Exact::new(&mesh);
        let grid = winding.grid(&low, step, counts);
        assert_eq!(grid.len(), counts.iter().product::<usize>());
        for (n, found) in grid.iter().enumerate() {
            let place = [n / (counts[1] * counts[2]), n / counts[2] % counts[1], n % counts[2]];
            let point = low + Vector3::from(place.map(|i| step * i as f64));
            assert!((found - winding.at(&point)).abs() < 1e-12, "{point}");
        }
    }
}
