//! The world against what mechanics says.

mod common;

use common::{a_cap, advance, floating, sheet, worn};
use nalgebra::Vector3;
use seeone_core::Pose;
use seeone_sim::{Settings, Surroundings, World};

const GRAVITY: f64 = 9.81;

#[test]
fn free_fall_follows_half_g_t_squared() {
    let settings = Settings { gravity: Vector3::new(0.0, 0.0, -GRAVITY), ..floating() };
    let mut world = World::new(&a_cap(), &Pose::identity(), Surroundings::default(), settings);
    let start = world.centre_of_mass();
    advance(&mut world, 0.4);
    let fallen = start.z - world.centre_of_mass().z;
    let expected = GRAVITY * 0.4 * 0.4 / 2.0;
    assert!((fallen / expected - 1.0).abs() < 0.005, "{fallen} m instead of {expected}");
    assert!(world.strain().1 < 1e-6, "a falling shell is not strained");
}

/// How far a sheet slides down a slope of `degrees` within one second, friction 0.5.
fn slides(degrees: f64) -> f64 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let surroundings = Surroundings { table: true, ..Default::default() };
    let down = |x, z| Vector3::new(x, 0.0, z) * GRAVITY;
    let settings = Settings { gravity: down(0.0, -1.0), ..floating() };
    let mut world = World::new(&sheet(4), &Pose::identity(), surroundings, settings);
    advance(&mut world, 0.5);
    let start = world.centre_of_mass();
    world.set_gravity(down(sin, -cos));
    advance(&mut world, 1.0);
    world.centre_of_mass().x - start.x
}

#[test]
fn coulomb_friction_sticks_below_its_angle_and_slides_as_it_should_above() {
    assert!(slides(26.0).abs() < 1e-5, "{}", slides(26.0));
    for degrees in [30.0f64, 45.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let expected = GRAVITY * (sin - 0.5 * cos) / 2.0;
        let found = slides(degrees);
        assert!((found / expected - 1.0).abs() < 0.01, "{found} m instead of {expected}");
    }
}

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
fn the_same_start_gives_the_same_bytes() {
    let run = || {
        let surroundings = Surroundings { table: true, ..Default::default() };
        let placed = Pose::new(Vector3::new(0.0, 0.0, 0.2), Vector3::new(2.0, 0.4, 0.2));
        let mut world = World::new(&a_cap(), &placed, surroundings, Settings::default());
        advance(&mut world, 0.7);
        world
            .vertices()
            .iter()
            .flat_map(|p| p.coords.map(f64::to_bits).data.0[0])
            .collect::<Vec<_>>()
    };
    assert_eq!(run(), run());
}

#[test]
fn a_worn_cap_stays_but_is_not_glued() {
    let mut world = worn();
    let depth = world.min_signed_distance_to_head().expect("there is a head");
    assert!(depth > -1e-3, "sunk into the head by {depth}");
    let before = world.vertices().to_vec();
    advance(&mut world, 2.0);
    let creep =
        world.vertices().iter().zip(&before).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(creep < 1e-3, "{creep}");
    let centre = world.centre_of_mass();
    world.set_gravity(Vector3::z() * GRAVITY);
    advance(&mut world, 1.0);
    let moved = (world.centre_of_mass() - centre).norm();
    assert!(moved > 1.0, "turned over it moved by {moved} m only");
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
