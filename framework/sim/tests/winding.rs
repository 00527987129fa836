//! The winding number of worn caps on a grid, against the sum of all solid angles.

use nalgebra::{Point3, Vector3};
use rand::RngExt;
use rayon::prelude::*;
use seeone_core::TriangleMesh;
use seeone_core::random::generator;
use seeone_core::winding::Exact;
use seeone_sim::category::cap;
use seeone_sim::{Settings, worn::worn};
use std::f64::consts::PI;

const VOXELS: usize = 128;
/// Grid points that are compared for each cap: the reference takes long.
const COMPARED: usize = 20_000;

/// The sum of the triangles' solid angles by L'Huilier's theorem, each from the sides of its
/// spherical triangle and with the sign of its determinant.
fn reference(mesh: &TriangleMesh, point: &Point3<f64>) -> f64 {
    let angle = |index: usize| {
        let [a, b, c] = mesh.corners(index).map(|corner| (corner - point).normalize());
        let side =
            |p: &Vector3<f64>, q: &Vector3<f64>| 2.0 * (0.5 * (p - q).norm()).min(1.0).asin();
        let (ab, bc, ca) = (side(&a, &b), side(&b, &c), side(&c, &a));
        let s = 0.5 * (ab + bc + ca);
        let tan = |x: f64| (0.5 * x).tan().max(0.0);
        let excess = 4.0 * (tan(s) * tan(s - ab) * tan(s - bc) * tan(s - ca)).sqrt().atan();
        excess * a.dot(&b.cross(&c)).signum()
    };
    (0..mesh.triangles().len()).map(angle).sum::<f64>() / (4.0 * PI)
}

#[test]
fn the_grid_of_a_worn_cap_is_the_sum_of_all_solid_angles() {
    for name in ["cap-train-000", "cap-unseen-07"] {
        let object = cap::named(name).expect("a cap");
        let worn = worn(&object, &Settings::default()).expect("it sits");
        let mesh = worn.canonical.mesh().expect("a mesh");
        let step = 1.0 / VOXELS as f64;
        let low = Point3::from([0.5 * step; 3]);
        let grid = Exact::new(&mesh).grid(&low, step, [VOXELS; 3]);
        assert_eq!(grid.len(), VOXELS.pow(3));

        let mut rng = generator(1, name);
        let chosen: Vec<usize> = (0..COMPARED).map(|_| rng.random_range(0..grid.len())).collect();
        let worst = chosen
            .par_iter()
            .map(|n| {
                let place = [n / VOXELS.pow(2), n / VOXELS % VOXELS, n % VOXELS];
                let point = low + Vector3::from(place.map(|i| step * i as f64));
                (grid[*n] - reference(&mesh, &point)).abs()
            })
            .reduce(|| 0.0, f64::max);
        assert!(worst < 1e-9, "{name}: {worst:.1e} from the reference");

        let enclosed = grid.iter().filter(|w| **w > 0.5).count() as f64 / grid.len() as f64;
        assert!((0.05..0.3).contains(&enclosed), "{name}: {enclosed:.3} of the cube enclosed");
    }
}
