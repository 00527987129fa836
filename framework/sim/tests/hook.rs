//! A cap hung on the hook's peg by its own shape and friction.

#![allow(clippy::unwrap_used, reason = "tests")]

mod common;

use common::advance;
use nalgebra::{Rotation3, Translation3, UnitQuaternion, Vector3};
use seeone_core::Pose;
use seeone_sim::category::cap;
use seeone_sim::expert::VisorGrasp;
use seeone_sim::surroundings::Peg;
use seeone_sim::{Hand, Hook, Object, Region, Settings, Surroundings, World};

/// Where the peg leaves the wall, metres.
const HOOK_M: [f64; 3] = [0.0, 0.4, 0.55];
/// The front panel slides in this far above the peg's axis, metres.
const CLEARANCE_M: f64 = 0.035;
/// So far before the peg's tip, along its axis, the cap begins to slide in, metres.
const BEFORE_M: f64 = 0.03;
/// It stops when the visor is so near to the wall, metres.
const WALL_GAP_M: f64 = 0.005;

/// The hook, whose peg points away from the wall along -y.
fn hook() -> Hook {
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), std::f64::consts::PI);
    Hook::coat(Pose::from_parts(Translation3::from(Vector3::from(HOOK_M)), turn))
}

/// The cap before the peg, `beside` metres to its side, held by the visor: the opening to
/// the wall, the visor up. The second value is how far along the peg it can slide.
fn before_the_peg(object: &Object, beside: f64) -> (World, f64) {
    let hook = hook();
    let out = hook.pose.rotation * Vector3::y();
    // Object z away from the wall and object y, where the visor points, up.
    let axes = [Vector3::z().cross(&out), Vector3::z(), out];
    let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_basis_unchecked(&axes));
    let vertices = object.mesh().vertices();
    let hem = object.vertices_of(Region::Hem);
    let front = hem.iter().map(|v| vertices[*v]).max_by(|a, b| a.y.total_cmp(&b.y)).unwrap();
    // How far what is nearest to the wall lies nearer than the front of the hem.
    let ahead = front.z - vertices.iter().map(|v| v.z).fold(f64::INFINITY, f64::min);
    let axis = hook.pose.rotation * Peg::axis();
    let far = hook.tip() + axis * (BEFORE_M + ahead / axis.dot(&out));
    let at = far + Vector3::z() * CLEARANCE_M + Vector3::x() * beside;
    let placed = Pose::from_parts(Translation3::from(at - rotation * front.coords), rotation);
    let slide = BEFORE_M + hook.peg.length_m() - WALL_GAP_M / axis.dot(&out);
    let surroundings = Surroundings { table: true, hooks: vec![hook], ..Surroundings::default() };
    let settings = Settings { gravity: Vector3::zeros(), ..Settings::default() };
    let mut world = World::new(object, &placed, surroundings, settings);
    let tool = VisorGrasp::of(object, 0.0).unwrap().tool_on(world.vertices());
    world.move_hand(&Hand { pose: tool, opening_m: 0.03 });
    world.close(140.0);
    advance(&mut world, 0.5);
    assert!(world.hand_state().held_points > 0);
    world.set_gravity(Vector3::z() * -9.81);
    (world, slide)
}

/// Moves the hand by `way` (world) in `seconds`.
fn carry(world: &mut World, way: &Vector3<f64>, seconds: f64) {
    let hand = *world.hand().unwrap();
    let frames = (seconds * 60.0).round() as usize;
    for frame in 1..=frames {
        let share = frame as f64 / frames as f64;
        let eased = share * share * (3.0 - 2.0 * share);
        world.move_hand(&Hand { pose: Translation3::from(way * eased) * hand.pose, ..hand });
        world.advance();
    }
}

/// Slides the cap onto the peg, or past it, lets it go, and shakes it.
fn hang(object: &Object, beside: f64) -> World {
    let (mut world, slide) = before_the_peg(object, beside);
    let axis = hook().pose.rotation * Peg::axis();
    carry(&mut world, &(-axis * slide), 1.5);
    carry(&mut world, &(Vector3::z() * -CLEARANCE_M), 0.5);
    world.open(0.06);
    advance(&mut world, 0.3);
    let back = world.hand().unwrap().pose.rotation * Vector3::z() * -0.18;
    carry(&mut world, &back, 0.8);
    world.remove_hand();
    advance(&mut world, 2.0);
    for frame in 0..60 {
        let phase = f64::from(frame) / 60.0 * 2.0 * std::f64::consts::TAU;
        world.set_gravity(Vector3::new(0.5 * phase.sin().signum(), 0.0, -9.81));
        world.advance();
    }
    world
}

const CAPS: [&str; 4] = ["cap-unseen-00", "cap-unseen-05", "cap-unseen-11", "cap-unseen-15"];

#[test]
fn a_cap_hangs_by_its_front_panel_and_stands_a_shake() {
    for name in CAPS {
        let world = hang(&cap::named(name).unwrap(), 0.0);
        assert_eq!(world.hand_state().held_points, 0);
        let peg = world.min_signed_distance_to_peg().unwrap();
        assert!((-1e-3..1e-3).contains(&peg), "{name}: {peg} m from the peg");
        let lowest = world.vertices().iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
        assert!(lowest > 0.1, "{name}: its lowest point is {lowest} m over the table");
        let centre = world.centre_of_mass();
        let tip = hook().tip();
        assert!(centre.z < tip.z && (centre - tip).norm() < 0.15, "{name}: at {centre}");
        let into_wall = world.vertices().iter().map(|p| p.y - HOOK_M[1]).fold(f64::MIN, f64::max);
        assert!(into_wall < 1e-3, "{name}: {into_wall} m in the wall");
    }
}

#[test]
fn a_cap_let_go_beside_the_peg_falls() {
    for name in CAPS {
        let world = hang(&cap::named(name).unwrap(), 0.15);
        assert!(world.min_signed_distance_to_peg().unwrap() > 0.1, "{name}");
        assert!(world.centre_of_mass().z < 0.2, "{name}");
    }
}
