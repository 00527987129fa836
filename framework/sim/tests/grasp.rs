//! What a grip can carry: twice the friction of a pad, and no more.

#![allow(clippy::unwrap_used, reason = "tests")]

mod common;

use common::{advance, sheet};
use nalgebra::{Translation3, UnitQuaternion, Vector3};
use seeone_core::Pose;
use seeone_core::pose::rotation_from_approach;
use seeone_sim::{Frictions, Hand, Settings, Surroundings, World};

const GRAVITY: f64 = 9.81;
/// Acceleration of the lift, m/s2, and how long it lasts, s.
const LIFT_M_S2: f64 = 3.0;
const LIFT_S: f64 = 0.4;

/// A sheet of 80 mm that hangs upright in the plane y = 0, and a hand from above about its
/// upper edge, whose line of closing goes through the middle: no torque decides here.
fn hanging(friction: f64) -> World {
    let upright = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::FRAC_PI_2);
    let placed = Pose::from_parts(Translation3::new(0.0, 0.0, 0.5), upright);
    let frictions = Frictions { pad: friction, ..Frictions::default() };
    let surroundings = Surroundings { frictions, ..Surroundings::default() };
    let settings =
        Settings { gravity: Vector3::zeros(), velocity_damping: 0.0, ..Settings::default() };
    let mut world = World::new(&sheet(4), &placed, surroundings, settings);
    hand_at(&mut world, 0.53);
    world
}

/// Puts an open hand that points down to the height `z`.
fn hand_at(world: &mut World, z: f64) {
    let down = rotation_from_approach(&-Vector3::z(), &Vector3::y());
    let pose = Pose::from_parts(Translation3::new(0.0, 0.0, z), down);
    world.move_hand(&Hand { pose, opening_m: 0.02 });
}

/// Whether a grip of `force_n` still holds the sheet after it was lifted.
fn holds(force_n: f64, friction: f64) -> bool {
    let mut world = hanging(friction);
    world.close(force_n);
    advance(&mut world, 0.5);
    assert!(world.hand_state().held_points >= 4, "gripped");
    world.set_gravity(Vector3::z() * -GRAVITY);
    advance(&mut world, 0.3);
    for frame in 1..=(LIFT_S * 60.0) as u32 {
        let time = f64::from(frame) / 60.0;
        hand_at(&mut world, 0.53 + LIFT_M_S2 * time * time / 2.0);
        world.advance();
    }
    world.hand_state().held_points > 0
}

#[test]
fn a_grip_holds_what_its_friction_carries_and_nothing_more() {
    for friction in [0.4, 0.8] {
        let needed_n = sheet(4).mass() * (GRAVITY + LIFT_M_S2) / (2.0 * friction);
        assert!(holds(1.02 * needed_n, friction), "friction {friction}");
        assert!(!holds(0.95 * needed_n, friction), "friction {friction}");
        assert!(!holds(0.5 * needed_n, friction), "friction {friction}");
    }
}

#[test]
fn a_slip_is_a_slip() {
    let mut world = hanging(0.8);
    world.close(0.5 * world.mass() * GRAVITY / (2.0 * 0.8));
    advance(&mut world, 0.5);
    world.set_gravity(Vector3::z() * -GRAVITY);
    let start = world.centre_of_mass().z;
    advance(&mut world, 0.6);
    let state = world.hand_state();
    assert!(state.closed && state.held_points == 0, "the fingers stay closed on nothing");
    assert!(start - world.centre_of_mass().z > 0.3, "it falls, and is not gripped again");
}

#[test]
fn a_pinch_of_too_few_points_is_no_grip() {
    let mut world = hanging(0.8);
    // The finger tips reach a millimetre over the sheet's edge: one vertex and two middles
    // of edges lie between them.
    hand_at(&mut world, 0.54 - 0.001 + 0.010);
    world.advance();
    world.close(20.0);
    advance(&mut world, 0.5);
    assert!(world.hand_state().closed);
    assert_eq!(world.hand_state().held_points, 0);
}
