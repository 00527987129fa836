//! A triangle rasteriser with a depth buffer: which point of which triangle does each
//! pixel of a pinhole camera see?

use nalgebra::{Point3, Vector3};
use seeone_core::{Intrinsics, Pose, TriangleMesh};

/// Nothing nearer to the camera than this is drawn, metres.
const NEAR_M: f64 = 0.02;

/// The point that a pixel sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Index of the mesh among those drawn.
    pub mesh: u32,
    /// Index of its triangle.
    pub triangle: u32,
    /// Barycentric coordinates on that triangle, perspective-correct; they add up to one.
    pub weights: [f64; 3],
    /// Depth along the optical axis, metres.
    pub depth_m: f64,
}

impl Hit {
    /// The value at this point of a quantity known at the triangle's corners.
    pub fn interpolate(&self, corners: [Vector3<f64>; 3]) -> Vector3<f64> {
        let [a, b, c] = self.weights;
        corners[0] * a + corners[1] * b + corners[2] * c
    }
}

/// What every pixel sees, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    /// The camera.
    pub intrinsics: Intrinsics,
    /// One entry per pixel.
    pub hits: Vec<Option<Hit>>,
}

impl Raster {
    /// What pixel `(column, row)` sees; nothing outside the image.
    pub fn at(&self, column: isize, row: isize) -> Option<&Hit> {
        let (w, h) = (self.intrinsics.width as isize, self.intrinsics.height as isize);
        let inside = (0..w).contains(&column) && (0..h).contains(&row);
        inside.then(|| self.hits[(row * w + column) as usize].as_ref()).flatten()
    }
}

/// A corner of a clipped polygon: a camera-frame point and its place on the triangle.
#[derive(Clone, Copy)]
struct Corner {
    point: Point3<f64>,
    weights: Vector3<f64>,
}

/// Draws `meshes`, given in `world`, as seen by a camera whose pose in `world` is `camera`.
/// Both sides of a triangle are visible; of two equally near triangles the first stays.
pub fn rasterize(meshes: &[&TriangleMesh], camera: &Pose, intrinsics: &Intrinsics) -> Raster {
    let mut raster =
        Raster { intrinsics: *intrinsics, hits: vec![None; intrinsics.width * intrinsics.height] };
    let to_camera = camera.inverse();
    for (number, mesh) in meshes.iter().enumerate() {
        let vertices: Vec<Point3<f64>> = mesh.vertices().iter().map(|v| to_camera * v).collect();
        for (index, triangle) in mesh.triangles().iter().enumerate() {
            let corners = triangle.map(|v| vertices[v as usize]);
            let polygon = clipped(&corners);
            for i in 2..polygon.len() {
                let part = [polygon[0], polygon[i - 1], polygon[i]];
                fill(&mut raster, &part, number as u32, index as u32);
            }
        }
    }
    raster
}

/// The part of the triangle in front of the near plane (Sutherland and Hodgman 1974).
fn clipped(corners: &[Point3<f64>; 3]) -> Vec<Corner> {
    let corner = |i: usize| Corner { point: corners[i], weights: Vector3::ith(i, 1.0) };
    let mut polygon = Vec::with_capacity(4);
    for i in 0..3 {
        let (a, b) = (corner(i), corner((i + 1) % 3));
        if a.point.z >= NEAR_M {
            polygon.push(a);
        }
        if (a.point.z >= NEAR_M) != (b.point.z >= NEAR_M) {
            let t = (NEAR_M - a.point.z) / (b.point.z - a.point.z);
            polygon.push(Corner {
                point: a.point + (b.point - a.point) * t,
                weights: a.weights.lerp(&b.weights, t),
            });
        }
    }
    polygon
}

/// Fills one triangle; depth and weights are interpolated linearly in `1/z`.
fn fill(raster: &mut Raster, part: &[Corner; 3], mesh: u32, triangle: u32) {
    let camera = raster.intrinsics;
    let screen = part.map(|c| {
        let inverse = 1.0 / c.point.z;
        (camera.fx * c.point.x * inverse + camera.cx, camera.fy * c.point.y * inverse + camera.cy)
    });
    let edge = |a: (f64, f64), b: (f64, f64), p: (f64, f64)| {
        (b.0 - a.0) * (p.1 - a.1) - (b.1 - a.1) * (p.0 - a.0)
    };
    let area = edge(screen[0], screen[1], screen[2]);
    if area == 0.0 || !area.is_finite() {
        return;
    }
    let span = |values: [f64; 3], limit: usize| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min).ceil().max(0.0);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max).floor();
        low as usize..(high + 1.0).clamp(0.0, limit as f64) as usize
    };
    let columns = span(screen.map(|s| s.0), camera.width);
    for row in span(screen.map(|s| s.1), camera.height) {
        for column in columns.clone() {
            let p = (column as f64, row as f64);
            let w = [
                edge(screen[1], screen[2], p) / area,
                edge(screen[2], screen[0], p) / area,
                edge(screen[0], screen[1], p) / area,
            ];
            if w.iter().any(|v| *v < 0.0) {
                continue;
            }
            let over_z = [0, 1, 2].map(|i| w[i] / part[i].point.z);
            let depth_m = 1.0 / over_z.iter().sum::<f64>();
            let pixel = &mut raster.hits[row * camera.width + column];
            if pixel.is_none_or(|seen| depth_m < seen.depth_m) {
                let weights =
                    (0..3).map(|i| part[i].weights * (over_z[i] * depth_m)).sum::<Vector3<f64>>();
                *pixel = Some(Hit { mesh, triangle, weights: weights.into(), depth_m });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera() -> Intrinsics {
        Intrinsics { width: 64, height: 48, fx: 40.0, fy: 40.0, cx: 31.5, cy: 23.5 }
    }

    fn tilted_sheet() -> TriangleMesh {
        let corners = [[-2.0, -2.0, 0.5], [2.0, -2.0, 0.5], [0.0, 3.0, 3.0]];
        TriangleMesh::new(corners.map(Point3::from).to_vec(), vec![[0, 1, 2]]).expect("a mesh")
    }

    #[test]
    fn a_hit_lies_on_its_pixels_ray() {
        let mesh = tilted_sheet();
        let raster = rasterize(&[&mesh], &Pose::identity(), &camera());
        let mut seen = 0;
        for (i, hit) in raster.hits.iter().enumerate() {
            let Some(hit) = hit else { continue };
            let on_mesh = hit.interpolate(mesh.corners(0).map(|c| c.coords));
            let on_ray = camera().deproject(i % 64, i / 64, hit.depth_m);
            assert!((on_mesh - on_ray.coords).norm() < 1e-9);
            seen += 1;
        }
        assert!(seen > 1000, "{seen} pixels");
    }

    #[test]
    fn the_nearer_mesh_hides_the_farther_in_any_order() {
        let far = tilted_sheet();
        let near = far
            .with_vertices(far.vertices().iter().map(|v| v - Vector3::z() * 0.1).collect())
            .expect("a mesh");
        for (meshes, expected) in [([&near, &far], 0), ([&far, &near], 1)] {
            let raster = rasterize(&meshes, &Pose::identity(), &camera());
            assert_eq!(raster.at(31, 23).map(|h| h.mesh), Some(expected));
        }
    }

    #[test]
    fn a_triangle_that_reaches_behind_the_camera_is_cut_off() {
        let corners = [[-1.0, 1.0, -2.0], [1.0, 1.0, -2.0], [0.0, 1.0, 6.0]];
        let mesh =
            TriangleMesh::new(corners.map(Point3::from).to_vec(), vec![[0, 1, 2]]).expect("a mesh");
        let raster = rasterize(&[&mesh], &Pose::identity(), &camera());
        assert!(raster.at(31, 40).is_some(), "the floor in front is seen");
        assert!(raster.at(31, 10).is_none(), "nothing above the horizon");
        assert!(raster.hits.iter().flatten().all(|h| h.depth_m >= NEAR_M - 1e-12));
    }
}
