//! What the network is taught: winding numbers of the canonical meshes at query points.

use crate::surface::{SurfaceSampler, triangles};
use nalgebra::{Point3, Vector3};
use seeone_core::TriangleMesh;
use seeone_core::random::{generator, normal, uniform};
use seeone_core::winding::Exact;

/// Standard deviation of the near-surface queries about the surface, in cube units.
const SURFACE_SPREAD: f64 = 0.03;

/// Query points of one object with their true winding numbers (Eq. 5's ground truth).
#[derive(Clone, Debug, PartialEq)]
pub struct Supervision {
    /// Points of the canonical cube. Those of even index are uniform in it, the others lie
    /// near the surface, so that any run of them is half and half.
    pub queries: Vec<[f32; 3]>,
    /// The winding number at each.
    pub winding: Vec<f32>,
}

impl Supervision {
    /// `count` queries for a canonical mesh; `stream` keeps the draws of objects apart.
    pub fn new(mesh: &TriangleMesh, count: usize, seed: u64, stream: &str) -> Self {
        let mut rng = generator(seed, stream);
        let surface = SurfaceSampler::new(triangles(mesh));
        let points: Vec<Point3<f64>> = (0..count)
            .map(|i| match &surface {
                Some(surface) if i % 2 == 1 => {
                    let offset = Vector3::from_fn(|_, _| SURFACE_SPREAD * normal(&mut rng));
                    surface.sample(&mut rng) + offset
                }
                _ => Point3::from(Vector3::from_fn(|_, _| uniform(&mut rng, 0.0, 1.0))),
            })
            .collect();
        let exact = Exact::new(mesh);
        let winding = points.iter().map(|p| exact.at(p) as f32).collect();
        let queries = points.iter().map(|p| [p.x as f32, p.y as f32, p.z as f32]).collect();
        Self { queries, winding }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_caps::cap;

    #[test]
    fn halves_are_uniform_and_near_the_surface_and_a_seed_repeats_them() {
        let mesh = cap(0.0);
        let made = Supervision::new(&mesh, 2000, 1, "a");
        assert_eq!(made, Supervision::new(&mesh, 2000, 1, "a"));
        assert_ne!(made, Supervision::new(&mesh, 2000, 2, "a"));
        let distance = |q: &[f32; 3]| {
            let q = Point3::new(f64::from(q[0]), f64::from(q[1]), f64::from(q[2]));
            let to = mesh.vertices().iter().map(|v| (v - q).norm());
            to.fold(f64::INFINITY, f64::min)
        };
        let mean = |start: usize| {
            let picked = made.queries.iter().skip(start).step_by(2);
            picked.map(distance).sum::<f64>() / 1000.0
        };
        assert!(mean(0) > 2.0 * mean(1), "uniform {}, near {}", mean(0), mean(1));
    }

    #[test]
    fn a_cap_surrounds_what_is_under_its_crown() {
        let made = Supervision::new(&cap(0.0), 3000, 1, "a");
        let (mut inside, mut outside) = (0, 0);
        for w in &made.winding {
            inside += usize::from(*w > 0.6);
            outside += usize::from(w.abs() < 0.1);
        }
        assert!(inside > 150 && outside > 500, "{inside} inside, {outside} outside");
    }
}
