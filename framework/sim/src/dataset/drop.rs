//! One drop: simulated, and seen while it falls, when it rests and when it is held up.

use super::Plan;
use super::held::Grips;
use super::view::{self, View};
use crate::drop::Drop;
use crate::object::Object;
use crate::rigid_fit::rigid_fit;
use crate::surroundings::Surroundings;
use crate::world::{FRAME_S, Settings, World};
use nalgebra::{Point3, Vector3};
use seeone_core::frames::{CanonicalObject, Frame, FrameInfo, Moment};
use seeone_core::random::{Generator, generator, uniform};

/// One drop of so many is also seen while it falls: a fifth of the frames.
const FALLING_ONE_OF: usize = 3;
/// Two drops of seven are also gripped and held up: a sixth of the frames.
const HELD_TURNS: [usize; 2] = [1, 4];
const TURNS: usize = 7;
/// When a falling object is seen, seconds after it was let go: in the air, at the first
/// touch, and crumpling on the mat.
const FALLING_S: (f64, f64) = (0.12, 0.45);
/// A drop is given this long to come to rest, seconds.
const SETTLE_S: f64 = 5.0;

/// What all drops of an object share.
pub struct Dropped<'a> {
    number: usize,
    object: &'a Object,
    canonical: &'a CanonicalObject,
    /// The canonical shape about its cube's middle, metres.
    shape: Vec<Point3<f64>>,
    grips: Grips<'a>,
    seed: u64,
    views: usize,
}

impl<'a> Dropped<'a> {
    /// The drops of object `number` of `plan`.
    pub fn new(plan: &'a Plan, number: usize, canonical: &'a CanonicalObject) -> Self {
        let object = &plan.objects[number];
        let metres = |v: &[f64; 3]| Vector3::from(v.map(|c| (c - 0.5) * canonical.edge_m)).into();
        Self {
            number,
            object,
            canonical,
            shape: canonical.vertices.iter().map(metres).collect(),
            grips: Grips::of(object),
            seed: plan.seed,
            views: plan.views.get(),
        }
    }

    /// Simulates drop number `drop` and takes its frames; none when the simulation diverges.
    pub fn frames(&self, drop: usize) -> Vec<Frame> {
        let mut rng = generator(self.seed, &format!("{}/drop-{drop}", self.object.name()));
        let table = Surroundings { table: true, ..Surroundings::default() };
        let settings = Settings::default();
        let mut world = Drop::draw([0.0, 0.0], &mut rng).begin(self.object, table, settings);
        let mut frames = Vec::new();
        // Objects take turns, so that a few drops of each still hold every moment.
        let turn = drop + self.number;
        if turn.is_multiple_of(FALLING_ONE_OF) {
            let seconds = uniform(&mut rng, FALLING_S.0, FALLING_S.1);
            (0..(seconds / FRAME_S).round() as usize).for_each(|_| world.advance());
            frames.extend(self.look(&world, drop, 0.0, Moment::Falling, &mut rng));
        }
        let at_rest = world.settle(SETTLE_S).at_rest;
        let moment = if at_rest { Moment::Resting } else { Moment::Falling };
        frames.extend(self.look(&world, drop, 0.0, moment, &mut rng));
        if at_rest
            && HELD_TURNS.contains(&(turn % TURNS))
            && let Some(held) = self.grips.hold_up(&world, &mut rng)
        {
            frames.extend(self.look(&held, drop, world.time(), Moment::Held, &mut rng));
        }
        if world.fault().is_some() { Vec::new() } else { frames }
    }

    /// Every view of a moment of a world that began `began_s` seconds after the drop.
    fn look(
        &self,
        world: &World,
        drop: usize,
        began_s: f64,
        moment: Moment,
        rng: &mut Generator,
    ) -> Vec<Frame> {
        let object_pose = (&rigid_fit(&self.shape, world.vertices())).into();
        let mut frames = Vec::new();
        for _ in 0..self.views {
            let camera = match world.hand() {
                Some(hand) => view::camera_at_hand(hand, rng),
                None => view::camera_at_mat(rng),
            };
            let Some(View { points, nocs }) = view::take(world, self.canonical, &camera, rng)
            else {
                continue;
            };
            let info = FrameInfo {
                object: self.number,
                drop,
                seconds: began_s + world.time(),
                moment,
                camera: (&camera).into(),
                object_pose,
            };
            frames.push(Frame { info, points, nocs });
        }
        frames
    }
}
