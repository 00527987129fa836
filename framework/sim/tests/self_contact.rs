//! Drops whose crowns dent deeply enough to fold onto themselves.

use nalgebra::Translation3;
use seeone_core::random::{generator, rotation};
use seeone_core::{Pose, TriangleMesh};
use seeone_sim::category::cap;
use seeone_sim::{Settings, Surroundings, World};
use std::collections::BTreeSet;

/// How many edges of the mesh pierce a triangle that they do not touch.
fn crossings(mesh: &TriangleMesh) -> usize {
    let edges: BTreeSet<(u32, u32)> = mesh
        .triangles()
        .iter()
        .flat_map(|[a, b, c]| [(a, b), (b, c), (c, a)])
        .map(|(a, b)| (*a.min(b), *a.max(b)))
        .collect();
    let pierces = |a: u32, b: u32, triangle: &[u32; 3]| {
        let [p, q] = [a, b].map(|v| mesh.vertices()[v as usize]);
        let [x, y, z] = triangle.map(|v| mesh.vertices()[v as usize]);
        let normal = (y - x).cross(&(z - x));
        let (before, after) = ((p - x).dot(&normal), (q - x).dot(&normal));
        let hit = p + (q - p) * (before / (before - after));
        let inside = [(x, y), (y, z), (z, x)]
            .iter()
            .all(|(from, to)| (to - from).cross(&(hit - from)).dot(&normal) > 0.0);
        before * after < 0.0 && inside
    };
    let apart = |a: u32, b: u32, t: &[u32; 3]| !t.contains(&a) && !t.contains(&b);
    edges
        .iter()
        .map(|(a, b)| {
            mesh.triangles().iter().filter(|t| apart(*a, *b, t) && pierces(*a, *b, t)).count()
        })
        .sum()
}

#[test]
fn a_dented_crown_does_not_go_through_itself() {
    for (name, seed) in [("cap-train-020", 100), ("cap-train-024", 101)] {
        let cap = cap::named(name).expect("a training cap");
        let turned = rotation(&mut generator(seed, name));
        let lowest = cap.mesh().vertices().iter().map(|p| (turned * p).z).fold(f64::MAX, f64::min);
        let placed = Pose::from_parts(Translation3::new(0.0, 0.0, 0.12 - lowest), turned);
        let surroundings = Surroundings { table: true, ..Default::default() };
        let mut world = World::new(&cap, &placed, surroundings, Settings::default());
        assert!(world.settle(6.0).at_rest, "{name} does not come to rest");
        assert_eq!(crossings(&world.mesh()), 0, "{name} is tangled");
    }
}
