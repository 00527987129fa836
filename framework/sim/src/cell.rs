//! The simulated work cell: one object, a mat, a head, and the hand of whatever arm is
//! plugged in. Robot and camera plugins share it; the verdict reads it.

use crate::depth_camera::look;
use crate::drop::Drop;
use crate::hand::Hand;
use crate::object::Object;
use crate::scenery;
use crate::surroundings::Surroundings;
use crate::world::{Settings, World};
use nalgebra::{Point3, Vector3};
use rand::Rng;
use seeone_core::{DepthImage, Intrinsics, Pose, TriangleMesh};

pub use crate::world::FRAME_S;

/// How long an object may roll and rock after it was dropped, seconds.
const SETTLE_LIMIT_S: f64 = 6.0;
/// How long a lifted object is watched before it counts as grasped, seconds.
const HOLD_S: f64 = 1.0;
/// A grasped object hangs clear of the table by at least this, metres.
const CLEAR_M: f64 = 0.10;
/// Where the fingers stand before the first command, metres.
const OPENING_M: f64 = 0.03;
/// Fingers that move less than this in a frame have stopped, metres.
const STILL_M: f64 = 1.0e-6;

/// A simulated work cell.
#[derive(Clone, Debug)]
pub struct Cell {
    object: Object,
    world: World,
    opening_m: f64,
    fingers_move: bool,
}

impl Cell {
    /// A cell in which `object` was let go as `drop` says and has come to rest, or has had
    /// six seconds to.
    ///
    /// # Errors
    /// A sentence when the simulation diverged.
    pub fn after_drop(
        object: Object,
        drop: &Drop,
        surroundings: Surroundings,
        settings: Settings,
    ) -> Result<Self, String> {
        let mut world = drop.begin(&object, surroundings, settings);
        world.settle(SETTLE_LIMIT_S);
        let cell = Self { object, world, opening_m: OPENING_M, fingers_move: false };
        cell.whole().map(|()| cell)
    }

    pub(crate) fn whole(&self) -> Result<(), String> {
        self.world.fault().map_or(Ok(()), |fault| Err(fault.to_string()))
    }

    /// The object.
    pub fn object(&self) -> &Object {
        &self.object
    }

    /// The world, for whoever judges or draws it.
    pub fn world(&self) -> &World {
        &self.world
    }

    pub(crate) fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }

    /// Seconds of simulated time.
    pub fn time_s(&self) -> f64 {
        self.world.time()
    }

    /// A noisy depth image from the pose `camera` of what stands in the cell: the table,
    /// the head, the hook, the object. The arm is expected to keep out of the picture.
    pub fn depth_image(
        &self,
        camera: &Pose,
        intrinsics: &Intrinsics,
        noise: &mut impl Rng,
    ) -> DepthImage {
        look(&self.surfaces(), camera, intrinsics, noise)
    }

    /// The surfaces, in `world`, of what stands in the cell: the table, the object, the head,
    /// the hook.
    pub fn surfaces(&self) -> Vec<TriangleMesh> {
        let mut meshes = vec![scenery::table(), self.world.mesh()];
        meshes.extend(self.head_mesh());
        meshes.extend(self.hook_mesh());
        meshes
    }

    /// The head's surface in `world`, when there is one.
    pub fn head_mesh(&self) -> Option<TriangleMesh> {
        self.world.surroundings().head.as_ref().map(scenery::head)
    }

    /// The hook's surface in `world`, with a piece of its wall, when there is one.
    pub fn hook_mesh(&self) -> Option<TriangleMesh> {
        self.world.surroundings().hook.as_ref().map(scenery::hook)
    }

    /// Puts the hand at a pose at once: where the arm is when the cell is set up.
    pub fn place_hand(&mut self, pose: &Pose) {
        self.world.move_hand(&Hand { pose: *pose, opening_m: self.opening_m });
    }

    /// One frame of [`FRAME_S`], at whose end the hand is at `pose`.
    ///
    /// # Errors
    /// A sentence when the simulation diverged.
    pub fn advance(&mut self, pose: &Pose) -> Result<(), String> {
        let before = self.world.hand_state().opening_m;
        self.world.move_hand(&Hand { pose: *pose, opening_m: self.opening_m });
        self.world.advance();
        let after = self.world.hand_state().opening_m;
        self.fingers_move = (after - before).abs() > STILL_M;
        self.whole()
    }

    /// Closes the fingers until they press with `force_n`, over the coming frames.
    pub fn close(&mut self, force_n: f64) {
        self.world.close(force_n);
    }

    /// Lets go at once and opens the fingers to `opening_m` over the coming frames.
    pub fn open(&mut self, opening_m: f64) {
        self.opening_m = opening_m;
        self.world.open(opening_m);
    }

    /// Whether the fingers moved in the last frame.
    pub fn fingers_move(&self) -> bool {
        self.fingers_move
    }

    /// Distance between the pads, metres.
    pub fn opening_m(&self) -> f64 {
        self.world.hand_state().opening_m
    }

    /// What a gripper's own force sensing tells: the fingers stopped against something.
    pub fn pads_feel_load(&self) -> bool {
        let state = self.world.hand_state();
        state.closed && state.held_points > 0
    }

    /// What the hand gives to what it holds, newtons in `world`: what a wrist that feels
    /// loads would tell. Zero when it holds nothing.
    pub fn load_n(&self) -> Vector3<f64> {
        self.world.hand_state().load_n
    }

    /// Whether the lifted object is truly held: the hand stands still for a second, and
    /// then the object still hangs from it clear of the table (method: Eq. 11).
    ///
    /// # Errors
    /// A sentence when the simulation diverged.
    pub fn holds_object(&mut self) -> Result<bool, String> {
        let Some(pose) = self.world.hand().map(|hand| hand.pose) else { return Ok(false) };
        for _ in 0..(HOLD_S / FRAME_S).round() as usize {
            self.advance(&pose)?;
        }
        let lowest = self.vertices().iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
        Ok(self.world.hand_state().held_points > 0 && lowest > CLEAR_M)
    }

    /// The object's vertices in `world`, metres.
    pub fn vertices(&self) -> &[Point3<f64>] {
        self.world.vertices()
    }

    /// Lets the world settle without a hand's help for at most `limit_s` seconds; says
    /// whether it came to rest.
    ///
    /// # Errors
    /// A sentence when the simulation diverged.
    pub fn settle(&mut self, limit_s: f64) -> Result<bool, String> {
        let settled = self.world.settle(limit_s);
        self.whole().map(|()| settled.at_rest)
    }
}
