//! From a shape to an object: crown, strap hole, brim, regions and materials.

use super::crown::{self, Facet};
use super::{CATEGORY, Resolution, brim, shape::Shape};
use crate::object::{Material, Object, Region};
use nalgebra::Point3;
use seeone_core::TriangleMesh;

/// Front structure from which on a cap has buckram in its two front panels.
const STRUCTURED: f64 = 0.35;
/// A strap hole narrower than this is none.
const SMALLEST_STRAP_HOLE_M: f64 = 0.02;
/// Height of the strap hole, as a part of the way from the hem to the apex.
const STRAP_HOLE_HEIGHT: f64 = 2.6 / 11.0;

/// The cap of this shape at rest, in the canonical orientation: z up, brim along +y.
pub fn assemble(name: &str, shape: &Shape, resolution: Resolution) -> Object {
    let mut vertices = crown::vertices(shape, resolution);
    let mut triangles = Vec::new();
    let mut regions = Vec::new();
    for facet in crown::facets(resolution) {
        if !in_strap_hole(shape, resolution, &facet, &vertices) {
            triangles.push(facet.triangle);
            regions.push(crown_region(shape, resolution, &facet));
        }
    }
    let brim = brim::build(shape, resolution, &vertices);
    vertices.extend(brim.vertices);
    regions.resize(regions.len() + brim.triangles.len(), Region::Brim);
    triangles.extend(brim.triangles);
    let (vertices, triangles) = without_loose_vertices(vertices, triangles);
    let mesh = TriangleMesh::new(vertices, triangles)
        .expect("the generator numbers only vertices that it made");
    Object::new(name, CATEGORY, mesh, regions, materials(shape), shape.softness_hz)
        .expect("every triangle has its region and every number is positive")
}

/// The strap hole is half an ellipse above the band of the last ring.
fn in_strap_hole(
    shape: &Shape,
    resolution: Resolution,
    facet: &Facet,
    vertices: &[Point3<f64>],
) -> bool {
    let corners = facet.triangle.map(|v| vertices[v as usize].coords);
    let centre = (corners[0] + corners[1] + corners[2]) / 3.0;
    let half_width = shape.strap_hole;
    if half_width < SMALLEST_STRAP_HOLE_M || facet.ring == resolution.rings() || centre.y > 0.0 {
        return false;
    }
    let up = (resolution.rings() as f64 - 0.5 - facet.ring as f64) / resolution.rings() as f64;
    (centre.x / half_width).powi(2) + (up / STRAP_HOLE_HEIGHT).powi(2) < 1.0
}

fn crown_region(shape: &Shape, resolution: Resolution, facet: &Facet) -> Region {
    if facet.ring == resolution.rings() {
        Region::Hem
    } else if shape.front_structure > STRUCTURED && matches!(facet.panel, 0 | 5) {
        Region::Front
    } else {
        Region::Crown
    }
}

/// Drops the vertices that no triangle uses.
fn without_loose_vertices(
    vertices: Vec<Point3<f64>>,
    mut triangles: Vec<[u32; 3]>,
) -> (Vec<Point3<f64>>, Vec<[u32; 3]>) {
    let mut used = vec![false; vertices.len()];
    for v in triangles.iter().flatten() {
        used[*v as usize] = true;
    }
    let mut kept = Vec::with_capacity(vertices.len());
    let mut number = vec![0; vertices.len()];
    for (i, vertex) in vertices.into_iter().enumerate().filter(|(i, _)| used[*i]) {
        number[i] = kept.len() as u32;
        kept.push(vertex);
    }
    for v in triangles.iter_mut().flatten() {
        *v = number[*v as usize];
    }
    (kept, triangles)
}

/// Materials indexed by [`Region`]: fabric, buckram-backed fabric, plastic-filled brim, and
/// the doubled band of the hem.
fn materials(shape: &Shape) -> [Material; 4] {
    let [crown, brim] = shape.density;
    let fabric = 10f64.powf(shape.bending_exponent);
    [
        Material { density_kg_m2: crown, bending_n_m: fabric, thickness_m: 0.001 },
        Material { density_kg_m2: crown * 1.1, bending_n_m: 5e-3, thickness_m: 0.0012 },
        Material { density_kg_m2: brim, bending_n_m: 0.1, thickness_m: 0.0028 },
        Material { density_kg_m2: crown * 2.0, bending_n_m: fabric * 4.0, thickness_m: 0.0015 },
    ]
}
