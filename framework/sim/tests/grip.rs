//! Gripping, carrying, letting go: by friction and never by glue.

mod common;

use common::{a_cap, advance, worn};
use nalgebra::{Point3, Translation3, Vector3};
use seeone_core::Pose;
use seeone_core::pose::rotation_from_approach;
use seeone_sim::{Hand, Region, Settings, Surroundings, World};

/// A floating cap with the gripper about the tip of its visor, pads open.
fn at_the_visor() -> World {
    at_the_visor_over(Surroundings::default())
}

/// The same over something, 70 mm above a table.
fn at_the_visor_over(surroundings: Surroundings) -> World {
    let settings = Settings { gravity: Vector3::zeros(), ..Settings::default() };
    let cap = a_cap();
    let lowest = cap.mesh().vertices().iter().map(|v| v.z).fold(f64::INFINITY, f64::min);
    let placed = Pose::translation(0.0, 0.0, 0.07 - lowest);
    let mut world = World::new(&cap, &placed, surroundings, settings);
    let visor: Vec<Point3<f64>> =
        cap.vertices_of(Region::Brim).iter().map(|v| world.vertices()[*v]).collect();
    let tip = visor.iter().copied().fold(visor[0], |a, p| if p.y > a.y { p } else { a });
    let inside = |p: &&Point3<f64>| p.x.abs() < 0.01 && (0.015..0.04).contains(&(tip.y - p.y));
    let inner = visor.iter().find(inside).expect("a visor is deeper than 40 mm");
    let approach = (inner - tip).normalize();
    let pose = Pose::from_parts(
        Translation3::from((tip + approach * 0.008).coords),
        rotation_from_approach(&approach, &Vector3::z()),
    );
    world.move_hand(&Hand { pose, opening_m: 0.03 });
    world
}

/// Closes with `force_n`, turns gravity on and lifts by 0.3 m in 1.2 s; gives back the
/// world and how far the centre of mass rose one second later.
fn lift(force_n: f64) -> (World, f64) {
    let mut world = at_the_visor();
    world.close(force_n);
    advance(&mut world, 0.5);
    assert!(world.hand_state().closed);
    let start = world.centre_of_mass();
    let hand = *world.hand().expect("a hand");
    world.set_gravity(Vector3::z() * -9.81);
    for frame in 1..=72 {
        let share = f64::from(frame) / 72.0;
        let height = 0.3 * share * share * (3.0 - 2.0 * share);
        world.move_hand(&Hand { pose: Translation3::new(0.0, 0.0, height) * hand.pose, ..hand });
        world.advance();
    }
    advance(&mut world, 1.0);
    let rise = world.centre_of_mass().z - start.z;
    (world, rise)
}

#[test]
fn a_firm_grip_carries_the_cap_and_opening_drops_it() {
    let (mut world, rise) = lift(20.0);
    assert!((rise - 0.3).abs() < 0.02, "rose by {rise} m");
    let state = world.hand_state();
    assert!(state.held_points >= 4 && state.slip_m < 0.002 && state.normal_force_n == 20.0);
    assert!(world.rms_speed() < 0.05, "{}", world.rms_speed());
    let weight_n = world.mass() * 9.81;
    let off_n = state.load_n - Vector3::z() * weight_n;
    assert!(off_n.norm() < 0.1 * weight_n, "the hand bears {} of {weight_n} N", state.load_n.z);
    let held = world.centre_of_mass().z;
    world.open(0.06);
    assert_eq!(world.hand_state().held_points, 0);
    advance(&mut world, 1.0);
    assert!(held - world.centre_of_mass().z > 1.0, "stuck to an open gripper");
}

#[test]
fn the_hand_feels_what_it_presses_the_cap_onto() {
    let mut world = at_the_visor_over(Surroundings { table: true, ..Surroundings::default() });
    world.close(140.0);
    advance(&mut world, 0.5);
    let hand = *world.hand().expect("a hand");
    let before = world.hand_state().load_n;
    let mut most_n: f64 = 0.0;
    for frame in 1..=120 {
        // At 50 mm/s down to where the crown is pressed 30 mm flat.
        let depth = f64::from(frame) * 0.05 / 60.0;
        world.move_hand(&Hand { pose: Translation3::new(0.0, 0.0, -depth) * hand.pose, ..hand });
        world.advance();
        let change_n = (world.hand_state().load_n - before).norm();
        if depth < 0.05 {
            assert!(change_n < 2.0, "{change_n} N {} mm above the table", 1e3 * (0.07 - depth));
        }
        most_n = most_n.max(change_n);
    }
    assert!(most_n > 5.0, "{most_n} N");
}

#[test]
fn a_grip_far_too_weak_drops_the_cap() {
    let (world, rise) = lift(0.5);
    assert_eq!(world.hand_state().held_points, 0);
    assert!(rise < -1.0, "rose by {rise} m");
}

#[test]
fn closing_on_nothing_holds_nothing() {
    let mut world = worn();
    world.move_hand(&Hand { pose: Pose::translation(0.5, 0.0, 0.5), opening_m: 0.02 });
    world.close(20.0);
    advance(&mut world, 0.5);
    assert!(world.hand_state().closed);
    assert_eq!(world.hand_state().held_points, 0);
}

#[test]
fn fingers_move_at_their_speed() {
    let mut world = worn();
    world.move_hand(&Hand { pose: Pose::translation(0.5, 0.0, 0.5), opening_m: 0.08 });
    world.close(20.0);
    advance(&mut world, 0.5);
    assert!((world.hand_state().opening_m - 0.03).abs() < 1e-9, "two fingers at 0.05 m/s each");
}
