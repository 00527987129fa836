//! What a cap does in the world: rest, stay worn, and fail with a word.

mod common;

use common::{a_cap, advance, floating, worn};
use nalgebra::Vector3;
use seeone_core::Pose;
use seeone_sim::{Settings, Surroundings, World};

const GRAVITY: f64 = 9.81;

#[test]
fn a_dropped_cap_rests_on_the_table_and_not_in_it() {
    let surroundings = Surroundings { table: true, ..Default::default() };
    let placed = Pose::new(Vector3::new(0.0, 0.0, 0.3), Vector3::new(0.9, 0.4, 0.2));
    let mut world = World::new(&a_cap(), &placed, surroundings, Settings::default());
    assert!(world.settle(6.0).at_rest);
    let lowest = world.vertices().iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    assert!(lowest > -1e-4, "{lowest}");
    assert!(world.strain().0 < 0.01 && world.shape_residual() < 0.02);
}

#[test]
fn a_worn_cap_stays_where_it_is() {
    let mut world = worn();
    let depth = world.min_signed_distance_to_head().expect("there is a head");
    assert!(depth > -1e-3, "sunk into the head by {depth}");
    let before = world.vertices().to_vec();
    advance(&mut world, 2.0);
    let creep =
        world.vertices().iter().zip(&before).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(creep < 1e-3, "{creep}");
}

#[test]
fn a_world_that_cannot_go_on_says_so_and_keeps_its_last_shape() {
    let mut world = World::new(&a_cap(), &Pose::identity(), Surroundings::default(), floating());
    let before = world.vertices().to_vec();
    world.set_gravity(Vector3::repeat(f64::NAN));
    world.advance();
    assert!(world.fault().is_some());
    assert_eq!(world.vertices(), before);
    world.advance();
    assert!(!world.settle(0.1).at_rest);
}

#[test]
fn what_is_pinned_stays_and_bears_what_pushes_it() {
    let settings = Settings { gravity: Vector3::z() * -GRAVITY, ..floating() };
    let mut world = World::new(&a_cap(), &Pose::identity(), Surroundings::default(), settings);
    let (start, count) = (world.vertices().to_vec(), world.vertices().len());
    let all: Vec<usize> = (0..count).collect();
    world.pin(&all).expect("its own vertices");
    world.push(7, Vector3::x()).expect("its own vertex");
    advance(&mut world, 0.2);
    assert_eq!(world.vertices(), start);
    world.pin(&[]).expect("none");
    advance(&mut world, 0.2);
    let moved = world.centre_of_mass()
        - World::new(&a_cap(), &Pose::identity(), Surroundings::default(), settings)
            .centre_of_mass();
    let expected = Vector3::new(1.0 / world.mass(), 0.0, -GRAVITY) * (0.2 * 0.2 / 2.0);
    assert!((moved - expected).norm() < 0.01 * expected.norm(), "{moved} instead of {expected}");
    assert!(world.pin(&[count]).is_err() && world.push(count, Vector3::x()).is_err());
    assert!(world.push(0, Vector3::repeat(f64::NAN)).is_err());
}
