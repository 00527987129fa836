//! From a shape to an object: crown, strap hole, brim, regions and materials.

use super::crown::{self, Dome, Facet};
use super::shape::Shape;
use super::template::{Pattern, Template};
use super::{CATEGORY, Resolution, brim};
use crate::object::{Material, Object, Region};
use nalgebra::Point3;
use seeone_core::TriangleMesh;
use std::f64::consts::PI;

/// Front structure from which on a cap has buckram in its two front panels.
const STRUCTURED: f64 = 0.35;

/// The cap of this shape at rest, in the canonical orientation: z up, brim along +y.
pub fn assemble(name: &str, template: Template, shape: &Shape, resolution: Resolution) -> Object {
    let pattern = template.pattern();
    let dome = Dome::new(shape, pattern, resolution);
    let mut vertices = dome.vertices();
    let (mut triangles, mut regions) = (Vec::new(), Vec::new());
    for facet in crown::facets(resolution) {
        if is_there(pattern, resolution, &facet) {
            triangles.push(facet.triangle);
            regions.push(crown_region(shape, resolution, &facet));
        }
    }
    let brim = brim::build(shape, pattern, resolution, &dome, &vertices);
    vertices.extend(brim.vertices);
    regions.resize(regions.len() + brim.triangles.len(), Region::Brim);
    triangles.extend(brim.triangles);
    let (vertices, triangles) = without_loose_vertices(vertices, triangles);
    let mesh = TriangleMesh::new(vertices, triangles)
        .expect("the generator numbers only vertices that it made");
    Object::new(name, CATEGORY, mesh, regions, materials(shape), shape.softness_hz)
        .expect("every triangle has its region and every number is positive")
        .with_symmetry(template.symmetry())
}

/// Whether a facet of the disc is part of the crown: below an open crown's upper end, and not
/// in the strap hole, which is half an ellipse above the band of the last ring. Both are told
/// by the disc alone, so that every cap of a template lacks the same facets.
fn is_there(pattern: &Pattern, resolution: Resolution, facet: &Facet) -> bool {
    let rings = resolution.rings();
    let in_hole = pattern.strap_hole.as_ref().is_some_and(|hole| {
        let up = (rings as f64 - 0.5 - facet.ring as f64) / rings as f64;
        let aside = facet.angle - PI;
        let inside = (aside / hole.half_angle).powi(2) + (up / hole.height).powi(2) < 1.0;
        inside && facet.ring < rings
    });
    facet.ring > pattern.first_ring(resolution) && !in_hole
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

/// Materials indexed by [`Region`]: fabric, buckram-backed fabric, brim, and the doubled
/// band of the hem.
fn materials(shape: &Shape) -> [Material; 4] {
    let fabric = 10f64.powf(shape.crown_bending_exponent);
    let brim = 10f64.powf(shape.brim_bending_exponent);
    let [crown_density, brim_density] = [shape.crown_density, shape.brim_density];
    // A brim that bends has no plastic in it.
    let brim_thickness_m = if brim < SOFT_BRIM_N_M { 0.002 } else { 0.0028 };
    let material = |density_kg_m2, bending_n_m, thickness_m| Material {
        density_kg_m2,
        bending_n_m,
        thickness_m,
    };
    [
        material(crown_density, fabric, 0.001),
        material(crown_density * 1.1, 5e-3, 0.0012),
        material(brim_density, brim, brim_thickness_m),
        material(crown_density * 2.0, fabric * 4.0, 0.0015),
    ]
}

/// Bending stiffness below which a brim is fabric alone, N m.
const SOFT_BRIM_N_M: f64 = 0.01;
