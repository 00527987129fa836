//! The same start, the same calls: the same bytes.

use crate::scenes::common::{a_cap, advance};
use nalgebra::{Translation3, Vector3};
use seeone_core::Pose;
use seeone_core::pose::rotation_from_approach;
use seeone_sim::{Hand, Region, Settings, Surroundings, World};

/// A cap is gripped by the visor in the air, let go, and drops onto the table: the bits of
/// every vertex, and how many points were held.
fn gripped_and_dropped() -> (Vec<[u64; 3]>, usize) {
    let cap = a_cap();
    let surroundings = Surroundings { table: true, ..Default::default() };
    let settings = Settings { gravity: Vector3::zeros(), ..Settings::default() };
    let placed = Pose::translation(0.0, 0.0, 0.1);
    let mut world = World::new(&cap, &placed, surroundings, settings);
    let visor = cap.vertices_of(Region::Brim);
    let tip = visor.iter().map(|v| world.vertices()[*v]).max_by(|a, b| a.y.total_cmp(&b.y));
    let tip = tip.expect("a visor has vertices");
    let pose = Pose::from_parts(
        Translation3::from(tip.coords),
        rotation_from_approach(&-Vector3::y(), &Vector3::z()),
    );
    world.move_hand(&Hand { pose, opening_m: 0.04 });
    world.close(20.0);
    advance(&mut world, 0.6);
    let held = world.hand_state().held_points;
    world.set_gravity(Vector3::z() * -9.81);
    world.move_hand(&Hand { pose: Translation3::new(0.0, 0.0, 0.02) * pose, opening_m: 0.04 });
    advance(&mut world, 0.3);
    world.open(0.06);
    advance(&mut world, 0.6);
    (world.vertices().iter().map(|p| [p.x, p.y, p.z].map(f64::to_bits)).collect(), held)
}

#[test]
fn the_same_calls_give_the_same_bytes() {
    let first = gripped_and_dropped();
    assert!(first.1 > 0, "nothing was gripped");
    assert_eq!(first, gripped_and_dropped());
}
