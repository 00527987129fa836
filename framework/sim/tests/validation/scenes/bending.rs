//! Cloth and visors that bend.

use super::check::Check;
use super::common::{a_cap, advance};
use super::plate::Plate;
use nalgebra::Vector3;
use seeone_core::Pose;
use seeone_sim::{Material, Region, Settings, Surroundings, World};

const GRAVITY: f64 = 9.81;

/// Strips held at one end sink at the other by w L^4 / (8 B) under their own weight w per
/// length and width, while that is little (Euler and Bernoulli's beam): the fabrics of caps,
/// 2e-5 to 5e-3 N m, at edges of 10 and 15 mm as caps have them.
///
/// What is too stiff for its edges and substeps sags too far, because one sweep carries
/// moments no farther than a ring of triangles: see [`convergence`]. A visor is far stiffer
/// still, and a rigid cluster for that reason.
pub fn cantilevers() -> Vec<Check> {
    let check = |bending_n_m: f64, length_m: f64, edge_m: f64, substeps| {
        let (length, edge) = (length_m * 1e3, edge_m * 1e3);
        let quantity = format!(
            "cantilever of {length:.0} mm, B {bending_n_m:e} N m, edges of {edge:.0} mm, \
             {substeps} substeps: droop"
        );
        let sunk = cantilever(bending_n_m, length_m, edge_m, substeps);
        Check::share(quantity, "w L^4 / (8 B)", "m", sunk, 0.25)
    };
    vec![
        check(2e-5, 0.025, 0.01, 40),
        check(1e-4, 0.03, 0.01, 40),
        check(1e-4, 0.04, 0.015, 40),
        check(1e-3, 0.05, 0.015, 40),
        check(1e-3, 0.06, 0.01, 40),
        check(1e-3, 0.06, 0.01, 160),
        check(5e-3, 0.08, 0.015, 40),
        check(5e-3, 0.08, 0.015, 320),
    ]
}

/// Substeps a frame of the columns of [`convergence`].
pub const SUBSTEPS: [usize; 5] = [20, 40, 80, 160, 320];

/// A row of the table of convergence.
pub struct Convergence {
    /// Bending stiffness, N m.
    pub bending_n_m: f64,
    /// Length, metres.
    pub length_m: f64,
    /// Edge, metres.
    pub edge_m: f64,
    /// Deviation of the droop from the formula as a share of it, for each of [`SUBSTEPS`].
    pub deviations: [f64; SUBSTEPS.len()],
}

/// The cantilever over mesh and substeps.
pub fn convergence() -> Vec<Convergence> {
    let mut rows = Vec::new();
    for (bending_n_m, length_m) in [(2e-5, 0.025), (1e-4, 0.04), (1e-3, 0.06), (5e-3, 0.08)] {
        for edge_m in [0.005, 0.01, 0.015] {
            let deviations = SUBSTEPS.map(|substeps| {
                let (expected, sunk) = cantilever(bending_n_m, length_m, edge_m, substeps);
                sunk / expected - 1.0
            });
            rows.push(Convergence { bending_n_m, length_m, edge_m, deviations });
        }
    }
    rows
}

/// How far the free end of a cantilever, 50 mm wide, sinks, metres, by
/// the formula w L^4 / (8 B) and in the world.
///
/// The two first columns are held. The first hinge that bends lies on the second of them and
/// stands for the half pitches on both of its sides, so the beam begins half a pitch before.
fn cantilever(bending_n_m: f64, length_m: f64, edge_m: f64, substeps: usize) -> (f64, f64) {
    let strips = (length_m / (edge_m * 0.75f64.sqrt()) + 0.5).round() as usize;
    let material = Material { density_kg_m2: 0.3, bending_n_m, thickness_m: 1e-3 };
    let across = (0.05 / edge_m).round() as usize;
    let plate = Plate { edge_m, strips, across, material };
    let mut world = plate.world(substeps, 10.0);
    plate.pin(&mut world, &[0, 1]);
    advance(&mut world, 2.0);
    let length = plate.length_m() - plate.pitch_m() / 2.0;
    let weight = material.density_kg_m2 * GRAVITY;
    (weight * length.powi(4) / (8.0 * bending_n_m), -plate.middle(&world, strips).z)
}

/// A cap's visor under 0.8 N at its tip, its hem held, bends by less than 5 mm: a moulded one
/// of B 0.05 to 0.3 N m does by 12 to 2 mm, F L^3 / (3 B b) over 70 by 150 mm.
pub fn visors() -> Vec<Check> {
    let quantity = "visor of a cap held at the hem, 0.8 N at its tip: gives way";
    vec![Check::at_most(quantity, "rigid", "m", visor(), 0.005)]
}

/// How far the tip of the visor gives way, metres.
fn visor() -> f64 {
    let cap = a_cap();
    let settings = Settings { gravity: Vector3::zeros(), ..Settings::default() };
    let mut world = World::new(&cap, &Pose::identity(), Surroundings::default(), settings);
    world.pin(&cap.vertices_of(Region::Hem)).unwrap();
    let y = |v: &usize| cap.mesh().vertices()[*v].y;
    let tip = cap.vertices_of(Region::Brim).into_iter().max_by(|a, b| y(a).total_cmp(&y(b)));
    let tip = tip.unwrap();
    world.push(tip, Vector3::z() * -0.8).unwrap();
    advance(&mut world, 2.0);
    (world.vertices()[tip] - cap.mesh().vertices()[tip]).norm()
}
