//! What must not count as worn, and what worn must mean.

#![allow(clippy::unwrap_used, reason = "tests")]

use nalgebra::{Translation3, UnitQuaternion, Vector3};
use seeone_core::Pose;
use seeone_sim::category::cap;
use seeone_sim::expert::VisorGrasp;
use seeone_sim::put_on::{Misplacement, PutOn, put_on};
use seeone_sim::worn::{Worn, worn};
use seeone_sim::{Frictions, Hand, Head, Object, Settings, Surroundings, WearError, World};
use std::f64::consts::PI;

const CAPS: [&str; 4] = ["cap-unseen-00", "cap-unseen-05", "cap-unseen-11", "cap-unseen-08"];
/// The largest error that counts as worn, in diameters of the cap.
const TOLERANCE_D: f64 = 0.1;
/// The largest error of a cap that is let go where it is worn.
const CEILING_D: f64 = 0.02;

fn head() -> Head {
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 0.4);
    Head::medium(Pose::from_parts(Translation3::new(0.1, 0.2, 0.3), turn))
}

fn cases() -> impl Iterator<Item = (Object, Worn)> {
    CAPS.into_iter().map(|name| {
        let object = cap::named(name).unwrap();
        let worn = worn(&object, &Settings::default()).unwrap();
        (object, worn)
    })
}

fn released(object: &Object, worn: &Worn, misplaced: Misplacement) -> (PutOn, WearError) {
    let end = put_on(object, worn, head(), &misplaced, &Settings::default());
    let error = WearError::of(worn, &end.reached(&head()));
    (end, error)
}

fn turned(axis: nalgebra::UnitVector3<f64>, angle: f64, raised: f64) -> Misplacement {
    let turn = UnitQuaternion::from_axis_angle(&axis, angle);
    Misplacement { shift: Vector3::z() * raised, turn }
}

#[test]
fn a_cap_let_go_where_it_is_worn_is_worn_by_itself() {
    for (object, worn) in cases() {
        let name = object.name();
        let (end, error) = released(&object, &worn, Misplacement::none());
        assert!(end.settled.at_rest, "{name}");
        assert!(error.mean_d < CEILING_D, "{name}: {error:?}");
        assert_eq!(end.world.hand_state().held_points, 0, "{name}: something still holds it");
        let depth = end.world.min_signed_distance_to_head().unwrap();
        assert!(depth > -1e-3, "{name}: {depth} m in the head");
    }
}

/// On a smooth head: at the usual friction of 0.5 a snug cap, whose hem lies at the widest
/// level or below it, wedges and stays on, as on a person who bends over.
#[test]
fn a_worn_cap_falls_off_when_gravity_is_turned_over() {
    for (object, worn) in cases() {
        let frictions = Frictions { head: 0.3, ..Frictions::default() };
        let smooth = Head::medium(Pose::identity());
        let surroundings = Surroundings { head: Some(smooth), frictions, ..Default::default() };
        let mut world = World::new(&object, &Pose::identity(), surroundings, Settings::default());
        world.set_vertices(&worn.vertices).unwrap();
        (0..30).for_each(|_| world.advance());
        let error = WearError::of(&worn, world.vertices());
        assert!(error.mean_d < 0.02, "{}: {error:?}", object.name());
        let centre = world.centre_of_mass();
        world.set_gravity(Vector3::z() * 9.81);
        (0..60).for_each(|_| world.advance());
        let moved = (world.centre_of_mass() - centre).norm();
        assert!(moved > 1.0, "{}: it moved by {moved} m only", object.name());
    }
}

#[test]
fn a_cap_let_go_wrongly_is_not_worn() {
    let beside = Misplacement { shift: Vector3::x() * 0.15, ..Misplacement::none() };
    let wrong = [
        ("beside the head", beside),
        ("upside down", turned(Vector3::y_axis(), PI, 0.12)),
        ("turned by 90 degrees", turned(Vector3::z_axis(), PI / 2.0, 0.0)),
        ("turned by 180 degrees", turned(Vector3::z_axis(), PI, 0.0)),
    ];
    for (object, worn) in cases() {
        for (how, misplaced) in wrong {
            let (end, error) = released(&object, &worn, misplaced);
            let name = object.name();
            assert!(error.mean_d > 2.0 * TOLERANCE_D, "{name} {how}: {error:?}");
            assert_eq!(end.world.hand_state().held_points, 0, "{name} {how}");
        }
    }
}

/// The hand goes through every motion of a wearing, but never presses.
#[test]
fn a_cap_that_was_never_grasped_is_not_worn() {
    for (object, worn) in cases() {
        let placed = Translation3::new(0.5, 0.2, 0.05) * Pose::identity();
        let surroundings =
            Surroundings { table: true, head: Some(head()), ..Surroundings::default() };
        let mut world = World::new(&object, &placed, surroundings, Settings::default());
        world.settle(3.0);
        let tool = VisorGrasp::of(&object, 0.0).unwrap();
        let start = tool.tool_on(world.vertices());
        let end = head().pose * tool.tool_on(&worn.vertices);
        world.move_hand(&Hand { pose: start, opening_m: 0.03 });
        world.close(0.0);
        (0..30).for_each(|_| world.advance());
        for frame in 1..=120 {
            let pose = start.lerp_slerp(&end, f64::from(frame) / 120.0);
            world.move_hand(&Hand { pose, opening_m: 0.03 });
            world.advance();
            assert_eq!(world.hand_state().held_points, 0, "{}", object.name());
        }
        world.open(0.06);
        world.settle(3.0);
        let to_head = head().pose.inverse();
        let reached: Vec<_> = world.vertices().iter().map(|v| to_head * v).collect();
        let error = WearError::of(&worn, &reached);
        assert!(error.mean_d > 2.0 * TOLERANCE_D, "{}: {error:?}", object.name());
    }
}
