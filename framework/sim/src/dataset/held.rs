//! Held up: a resting object gripped at its visor or at any other open edge, lifted, and
//! held still.

use crate::expert::VisorGrasp;
use crate::hand::Hand;
use crate::object::Object;
use crate::surroundings::Surroundings;
use crate::world::{FRAME_S, Settings, World};
use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use rand::RngExt;
use seeone_core::Pose;
use seeone_core::pose::rotation_from_approach;
use seeone_core::random::{Generator, direction, uniform};
use std::collections::BTreeMap;

/// Share of the grips at the visor, where an object has one; the others are at any edge.
const VISOR_SHARE: f64 = 0.65;
/// Largest angle between the hand's approach and the sheet, radians.
const PITCH_RAD: f64 = 1.05;
/// The hand comes from above: its approach points down by at least this, radians.
const LEAST_DESCENT_RAD: f64 = 0.17;
/// So many places are drawn until the hand can come from above.
const DRAWS: usize = 24;
/// So many grips are tried until one holds.
const TRIES: usize = 4;
/// The tool frame lies this far inside the edge, metres, as that of the visor's grasp.
const INSIDE_M: f64 = 0.012;
/// Opening around the edge, metres, and force, N: those of the shipped skill.
const OPENING_M: f64 = 0.03;
const GRIP_N: f64 = 140.0;
/// By how much the hand rises, metres.
const RISE_M: (f64, f64) = (0.25, 0.45);
/// By how much it turns about any axis on its way, radians.
const LARGEST_TURN_RAD: f64 = 0.6;
/// Closing, lifting and holding still, seconds.
const CLOSE_S: f64 = 0.4;
const LIFT_S: f64 = 1.2;
const STILL_S: f64 = 1.0;
/// A held object hangs at least this far over the mat, metres.
const CLEAR_M: f64 = 0.03;

/// Where an object can be gripped.
pub struct Grips<'a> {
    object: &'a Object,
    /// Edges with a triangle on one side only, and that triangle's third corner.
    rims: Vec<[usize; 3]>,
}

impl<'a> Grips<'a> {
    /// Those of `object`.
    pub fn of(object: &'a Object) -> Self {
        let mut sides: BTreeMap<[u32; 2], Vec<[u32; 3]>> = BTreeMap::new();
        for [a, b, c] in object.mesh().triangles() {
            for [a, b, c] in [[*a, *b, *c], [*b, *c, *a], [*c, *a, *b]] {
                sides.entry([a.min(b), a.max(b)]).or_default().push([a, b, c]);
            }
        }
        let open = |side: Vec<[u32; 3]>| match side[..] {
            [only] => Some(only.map(|v| v as usize)),
            _ => None,
        };
        Self { object, rims: sides.into_values().filter_map(open).collect() }
    }

    /// The world in which `resting` hangs from a hand that stands still, a second after
    /// the lift; `None` when no grip was found that holds.
    pub fn hold_up(&self, resting: &World, rng: &mut Generator) -> Option<World> {
        (0..TRIES).find_map(|_| {
            let pose = self.draw(resting.vertices(), rng)?;
            self.lifted(resting, &pose, rng)
        })
    }

    /// A pose of the hand, from above, on the object whose vertices are `now`.
    fn draw(&self, now: &[Point3<f64>], rng: &mut Generator) -> Option<Pose> {
        (0..DRAWS).find_map(|_| {
            let pitch = uniform(rng, -PITCH_RAD, PITCH_RAD);
            let at_visor = rng.random::<f64>() < VISOR_SHARE;
            let visor = at_visor.then(|| VisorGrasp::of(self.object, pitch)).flatten();
            let pose = match visor {
                Some(visor) => visor.tool_on(now),
                None => self.at_rim(now, pitch, rng)?,
            };
            let approach = pose.rotation * Vector3::z();
            (approach.z < -LEAST_DESCENT_RAD.sin()).then_some(pose)
        })
    }

    /// The hand about a random place of a random edge, its approach turned by `pitch` out
    /// of the sheet; `None` when the object is closed all around.
    fn at_rim(&self, now: &[Point3<f64>], pitch: f64, rng: &mut Generator) -> Option<Pose> {
        if self.rims.is_empty() {
            return None;
        }
        let [a, b, c] = self.rims[rng.random_range(0..self.rims.len())].map(|v| now[v]);
        let along = (b - a).normalize();
        let middle = a + (b - a) * rng.random::<f64>();
        let inward = (c - a) - along * along.dot(&(c - a));
        let inward = inward.try_normalize(f64::EPSILON)?;
        let normal = along.cross(&inward);
        let approach = inward * pitch.cos() - normal * pitch.sin();
        let rotation = rotation_from_approach(&approach, &normal);
        Some(Pose::from_parts((middle + inward * INSIDE_M).into(), rotation))
    }

    /// `resting` gripped at `pose`, lifted and held still; `None` when it was not held.
    fn lifted(&self, resting: &World, pose: &Pose, rng: &mut Generator) -> Option<World> {
        let surroundings = Surroundings { table: true, ..Surroundings::default() };
        let placed = Pose::identity();
        let mut world = World::new(self.object, &placed, surroundings, Settings::default());
        world.set_vertices(resting.vertices()).ok()?;
        let hand = Hand { pose: *pose, opening_m: OPENING_M };
        world.move_hand(&hand);
        world.close(GRIP_N);
        advance(&mut world, CLOSE_S, |_| hand);
        let rise = uniform(rng, RISE_M.0, RISE_M.1);
        let turn = direction(rng) * uniform(rng, 0.0, LARGEST_TURN_RAD);
        let carried = |share: f64| {
            let smooth = share * share * (3.0 - 2.0 * share);
            let up = Translation3::new(0.0, 0.0, rise * smooth) * pose.translation;
            let rotation = UnitQuaternion::from_scaled_axis(turn * smooth) * pose.rotation;
            Hand { pose: Pose::from_parts(up, rotation), ..hand }
        };
        let holds = |world: &World| world.hand_state().held_points > 0;
        for (seconds, from, to) in [(LIFT_S, 0.0, 1.0), (STILL_S, 1.0, 1.0)] {
            if !holds(&world) {
                return None;
            }
            advance(&mut world, seconds, |share| carried(from + (to - from) * share));
        }
        let clear = world.vertices().iter().all(|p| p.z > CLEAR_M);
        (holds(&world) && clear && world.fault().is_none()).then_some(world)
    }
}

/// Advances by `seconds`, in whose share `s` the hand shall be as `hand(s)` says.
fn advance(world: &mut World, seconds: f64, hand: impl Fn(f64) -> Hand) {
    let frames = (seconds / FRAME_S).round() as usize;
    for frame in 1..=frames {
        world.move_hand(&hand(frame as f64 / frames as f64));
        world.advance();
    }
}
