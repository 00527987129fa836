//! Putting a cap on a head by a hand that no arm carries: what the worn state forgives, apart
//! from everything that robot, perception and planning add.

use crate::expert::VisorGrasp;
use crate::hand::Hand;
use crate::object::{Object, Region};
use crate::surroundings::{Head, Surroundings};
use crate::world::{FRAME_S, Settings, Settled, World};
use crate::worn::Worn;
use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use rand::Rng;
use seeone_core::Pose;
use seeone_core::random::direction;

/// Grip force, newtons, as in the demonstrated skills.
const GRIP_N: f64 = 140.0;
/// Openings of the hand before and after, metres.
const OPENING_M: f64 = 0.03;
const OPENED_M: f64 = 0.06;
/// The cap arrives from this high over its worn pose with its visor raised, ...
const ARRIVE_M: f64 = 0.10;
const NOSE_UP_RAD: f64 = 10.0 * std::f64::consts::PI / 180.0;
/// ... and is levelled over this last height, metres.
const LEVEL_M: f64 = 0.01;
/// A hat without a stiff visor is let go this far above its worn pose, metres.
const PLACED_M: f64 = 0.005;
/// How far the open hand retracts, metres.
const RETRACT_M: f64 = 0.18;
/// Times: to close, to come down, to level, to open, to retract, s.
const CLOSE_S: f64 = 0.5;
const DOWN_S: f64 = 0.6;
const LEVEL_S: f64 = 0.3;
const OPEN_S: f64 = 0.3;
const RETRACT_S: f64 = 0.8;
/// How long a released cap may rock, s.
const SETTLE_S: f64 = 6.0;

/// By how much a cap is let go beside its worn pose: a turn about the middle of its
/// vertices, then a shift, both in the head frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Misplacement {
    /// Metres.
    pub shift: Vector3<f64>,
    /// About the middle of the vertices.
    pub turn: UnitQuaternion<f64>,
}

impl Misplacement {
    /// None: the worn pose itself.
    pub fn none() -> Self {
        Self { shift: Vector3::zeros(), turn: UnitQuaternion::identity() }
    }

    /// `shift_m` metres in a direction, and `turn_rad` radians about an axis, both drawn
    /// uniformly from all there are.
    pub fn draw(shift_m: f64, turn_rad: f64, rng: &mut impl Rng) -> Self {
        let shift = direction(rng) * shift_m;
        let turn = UnitQuaternion::from_scaled_axis(direction(rng) * turn_rad);
        Self { shift, turn }
    }
}

/// What came of it.
#[derive(Clone, Debug)]
pub struct PutOn {
    /// The world after it.
    pub world: World,
    /// How it came to rest.
    pub settled: Settled,
}

impl PutOn {
    /// The object's vertices in the frame of `head`, metres.
    pub fn reached(&self, head: &Head) -> Vec<Point3<f64>> {
        let to_head = head.pose.inverse();
        self.world.vertices().iter().map(|v| to_head * v).collect()
    }
}

/// Carries `object` by its visor to where it is worn on `head`, but for `misplaced`: from
/// above with the visor raised, level in the end. Then the hand opens and retracts, and the
/// object comes to rest. A hat without a visor is let go just above instead, and so is one
/// whose brim is soft: it droops in the hand, by more the fewer the substeps, and would not be
/// let go where it is worn.
pub fn put_on(
    object: &Object,
    worn: &Worn,
    head: Head,
    misplaced: &Misplacement,
    settings: &Settings,
) -> PutOn {
    let surroundings = Surroundings { table: true, head: Some(head), ..Surroundings::default() };
    let weightless = Settings { gravity: Vector3::zeros(), ..*settings };
    let mut world = World::new(object, &Pose::identity(), surroundings, weightless);
    let way = Way::to(worn, &head, misplaced);
    let stiff = object.materials()[Region::Brim.index()].is_rigid();
    match VisorGrasp::of(object, 0.0).filter(|_| stiff) {
        Some(grasp) => {
            place(&mut world, worn, &way.at(ARRIVE_M, NOSE_UP_RAD));
            let tool = grasp.tool_on(&worn.vertices);
            carry(&mut world, &way, &tool, &settings.gravity);
        }
        None => {
            place(&mut world, worn, &way.at(PLACED_M, 0.0));
            world.set_gravity(settings.gravity);
        }
    }
    let settled = world.settle(SETTLE_S);
    PutOn { world, settled }
}

/// Puts the object's worn vertices at `pose` (head frame -> world).
fn place(world: &mut World, worn: &Worn, pose: &Pose) {
    let vertices: Vec<_> = worn.vertices.iter().map(|v| pose * v).collect();
    world.set_vertices(&vertices).expect("as many as the object has, all finite");
}

fn carry(world: &mut World, way: &Way, tool: &Pose, gravity: &Vector3<f64>) {
    let hand = |pose: Pose| Hand { pose, opening_m: OPENING_M };
    world.move_hand(&hand(way.at(ARRIVE_M, NOSE_UP_RAD) * tool));
    world.close(GRIP_N);
    over(world, CLOSE_S, |_, _| {});
    world.set_gravity(*gravity);
    over(world, DOWN_S, |world, share| {
        let height = ARRIVE_M + (LEVEL_M - ARRIVE_M) * share;
        world.move_hand(&hand(way.at(height, NOSE_UP_RAD) * tool));
    });
    over(world, LEVEL_S, |world, share| {
        let rest = 1.0 - share;
        world.move_hand(&hand(way.at(LEVEL_M * rest, NOSE_UP_RAD * rest) * tool));
    });
    world.open(OPENED_M);
    over(world, OPEN_S, |_, _| {});
    let released = way.at(0.0, 0.0) * tool;
    over(world, RETRACT_S, |world, share| {
        let back = Translation3::new(0.0, 0.0, -RETRACT_M * share);
        world.move_hand(&Hand { pose: released * back, opening_m: OPENED_M });
    });
    world.remove_hand();
}

/// Advances by `seconds`, each frame after `act` was told how much of the motion is done:
/// smoothly from 0 to 1.
fn over(world: &mut World, seconds: f64, mut act: impl FnMut(&mut World, f64)) {
    let frames = (seconds / FRAME_S).round() as usize;
    for frame in 1..=frames {
        let share = frame as f64 / frames as f64;
        act(world, share * share * (3.0 - 2.0 * share));
        world.advance();
    }
}

/// The poses on the way of a worn object to its place.
struct Way {
    /// Head frame -> world, misplaced.
    end: Pose,
    /// Middle of the worn vertices, head frame.
    middle: Vector3<f64>,
}

impl Way {
    fn to(worn: &Worn, head: &Head, misplaced: &Misplacement) -> Self {
        let sum: Vector3<f64> = worn.vertices.iter().map(|v| v.coords).sum();
        let middle = sum / worn.vertices.len().max(1) as f64;
        let turn = about(&middle, misplaced.turn);
        Self { end: head.pose * Translation3::from(misplaced.shift) * turn, middle }
    }

    /// The pose (worn state in the head frame -> world) `height` metres above the end with
    /// the visor raised by `nose_up` radians.
    fn at(&self, height: f64, nose_up: f64) -> Pose {
        let nose = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), nose_up);
        Translation3::new(0.0, 0.0, height) * self.end * about(&self.middle, nose)
    }
}

/// A turn about a point.
fn about(point: &Vector3<f64>, turn: UnitQuaternion<f64>) -> Pose {
    Pose::from_parts(Translation3::from(point - turn * point), turn)
}
