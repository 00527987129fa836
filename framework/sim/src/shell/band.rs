//! The sweat band: a woven tape inside the hem, which keeps the whole hem's length.
//!
//! Springs along the edges know their neighbours alone. A push that widens the hem all
//! round is spread among them by one ring of neighbours a sweep, so that a cap slid down
//! a head as far as the substeps let it. One constraint on the length of the whole band
//! meets that push at once.

use super::topology::{Edge, opposite};
use crate::object::{Object, Region};
use nalgebra::{Point3, Vector3};

/// Tension of the tape at twice its length, N: a woven cotton tape of 25 mm stretches by a
/// tenth under some 50 N (design value).
const TAPE_N: f64 = 500.0;

/// The length of the band as one XPBD constraint, which pulls only.
///
/// As with the springs, each substep meets it at both ends of its sweeps with half of the
/// stiffness each time. Met once, between the sweeps, it shook a few hem vertices against
/// the head for ever.
#[derive(Clone, Debug)]
pub struct Band {
    /// Vertices along the band.
    vertices: Vec<usize>,
    /// Its edges, as indices into `vertices`.
    edges: Vec<[usize; 2]>,
    rest_m: f64,
    /// Gradient of the length at each vertex.
    gradient: Vec<Vector3<f64>>,
}

impl Band {
    /// The band along the lower border of the object's hem: `None` without a hem.
    pub fn new(object: &Object, edges: &[Edge]) -> Option<Self> {
        let mesh = object.mesh();
        let below = |edge: &Edge, triangle: usize| {
            let z = |v: usize| mesh.vertices()[v].z;
            let corner = opposite(&mesh.triangles()[triangle], edge.ends);
            z(corner) > (z(edge.ends[0]) + z(edge.ends[1])) / 2.0
        };
        let along = |edge: &&Edge| {
            let of = |region| {
                edge.triangles.iter().copied().filter(move |t| object.regions()[*t] == region)
            };
            let hem: Vec<usize> = of(Region::Hem).collect();
            let alone = hem.len() == 1 && 1 + of(Region::Brim).count() == edge.triangles.len();
            alone && below(edge, hem[0])
        };
        let ends: Vec<[usize; 2]> = edges.iter().filter(along).map(|e| e.ends).collect();
        let mut vertices: Vec<usize> = ends.iter().flatten().copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        let index = |v: usize| vertices.partition_point(|w| *w < v);
        let edges: Vec<[usize; 2]> = ends.iter().map(|e| e.map(index)).collect();
        let gradient = vec![Vector3::zeros(); vertices.len()];
        let mut band = Self { vertices, edges, rest_m: 0.0, gradient };
        band.rest_m = band.length(object.mesh().vertices());
        (band.rest_m > 0.0).then_some(band)
    }

    /// Draws the band towards its length in a substep of `h` seconds.
    pub fn solve(&mut self, position: &mut [Point3<f64>], inverse_mass: &[f64], h: f64) {
        self.gradient.fill(Vector3::zeros());
        let mut length = 0.0;
        for [a, b] in &self.edges {
            let apart = position[self.vertices[*b]] - position[self.vertices[*a]];
            let edge_m = apart.norm();
            if edge_m > 0.0 {
                length += edge_m;
                self.gradient[*a] -= apart / edge_m;
                self.gradient[*b] += apart / edge_m;
            }
        }
        if length <= self.rest_m {
            return; // a tape pulls; pushed, it would buckle in zigzag from edge to edge
        }
        let pairs = || self.vertices.iter().zip(&self.gradient);
        let weight: f64 = pairs().map(|(v, g)| inverse_mass[*v] * g.norm_squared()).sum();
        let lambda = -(length - self.rest_m) / (weight + 2.0 / (self.stiffness_n_m() * h * h));
        for (v, g) in pairs() {
            position[*v] += g * (inverse_mass[*v] * lambda);
        }
    }

    /// Elastic energy, J.
    pub fn energy(&self, position: &[Point3<f64>]) -> f64 {
        self.stiffness_n_m() * (self.length(position) - self.rest_m).max(0.0).powi(2) / 2.0
    }

    fn stiffness_n_m(&self) -> f64 {
        TAPE_N / self.rest_m
    }

    fn length(&self, position: &[Point3<f64>]) -> f64 {
        let at = |i: usize| position[self.vertices[i]];
        self.edges.iter().map(|[a, b]| (at(*b) - at(*a)).norm()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::topology;
    use super::*;
    use crate::category::cap;

    #[test]
    fn every_template_has_a_band_of_its_hem_that_a_widened_hem_shrinks_back_to() {
        for name in cap::names(cap::Set::Unseen) {
            let object = cap::named(&name).expect("a cap of this name");
            let edges = topology::edges(object.mesh().triangles());
            let mut band = Band::new(&object, &edges).expect("a band");
            assert!((0.5..0.58).contains(&band.rest_m), "{name}: {} m", band.rest_m);
            let wide = |p: &Point3<f64>| Point3::new(1.05 * p.x, 1.05 * p.y, p.z);
            let mut position: Vec<_> = object.mesh().vertices().iter().map(wide).collect();
            let weights: Vec<f64> = object.vertex_masses().iter().map(|m| 1.0 / m).collect();
            let before = band.energy(&position);
            (0..20).for_each(|_| band.solve(&mut position, &weights, 1.0 / 1200.0));
            assert!(band.energy(&position) < 0.01 * before, "{name}");
        }
    }
}
