//! Objects and worlds that several tests start from.

#![allow(clippy::unwrap_used, dead_code, reason = "tests")]

use nalgebra::{Point3, Vector3};
use seeone_core::{Pose, TriangleMesh};
use seeone_sim::category::cap;
use seeone_sim::{Head, Material, Object, Region, Settings, Surroundings, World};

/// A cap of the unseen set. Its fabric is stiff enough (1e-4 N m) for the crown to hardly sag
/// when only the visor is held.
pub fn a_cap() -> Object {
    cap::named("cap-unseen-08").unwrap()
}

/// A flat sheet of `n` by `n` squares of 20 mm in the plane z = 0.
pub fn sheet(n: u32) -> Object {
    let side = n + 1;
    let at = |i: u32| 0.02 * (f64::from(i) - f64::from(n) / 2.0);
    let vertices = (0..side * side).map(|i| Point3::new(at(i % side), at(i / side), 0.0)).collect();
    let triangles: Vec<[u32; 3]> = (0..n * n)
        .flat_map(|i| {
            let a = i / n * side + i % n;
            [[a, a + 1, a + side], [a + 1, a + side + 1, a + side]]
        })
        .collect();
    let regions = vec![Region::Crown; triangles.len()];
    let cloth = Material { density_kg_m2: 0.3, bending_n_m: 1e-4, thickness_m: 0.001 };
    let mesh = TriangleMesh::new(vertices, triangles).unwrap();
    Object::new("sheet", "sheet", mesh, regions, [cloth; 4], 4.0).unwrap()
}

/// No drag and no gravity, 20 substeps.
pub fn floating() -> Settings {
    Settings {
        substeps: 20,
        gravity: Vector3::zeros(),
        velocity_damping: 0.0,
        ..Settings::default()
    }
}

/// The cap settled on a head whose centre is 0.3 m over the table.
pub fn worn() -> World {
    let head = Head::medium(Pose::translation(0.0, 0.0, 0.3));
    let surroundings = Surroundings { table: true, head: Some(head), ..Default::default() };
    let placed = Pose::translation(0.0, 0.0, 0.32);
    let mut world = World::new(&a_cap(), &placed, surroundings, Settings::default());
    assert!(world.settle(4.0).at_rest);
    world
}

/// Advances by `seconds`.
pub fn advance(world: &mut World, seconds: f64) {
    (0..(seconds * 60.0).round() as usize).for_each(|_| world.advance());
}
