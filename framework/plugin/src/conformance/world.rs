//! A world in which nothing happens but what the hand does, for plugins that need one.

use crate::{PluginError, Surface, World, WorldState};
use nalgebra::{Point3, Vector3};
use seeone_core::{Pose, TriangleMesh};
use std::sync::{Mutex, PoisonError};

/// Seconds a frame.
const FRAME_S: f64 = 1.0 / 60.0;
/// How far the fingers move in one frame, metres.
const FINGER_STEP_M: f64 = 2e-3;
/// Half of the block's edge, metres.
const BLOCK_M: f64 = 0.06;

/// A table at z = 0 with a block on it, and a hand whose fingers close on nothing.
#[derive(Debug)]
pub struct StillWorld {
    hand: Mutex<Hand>,
    block: Point3<f64>,
}

#[derive(Clone, Copy, Debug)]
struct Hand {
    time_s: f64,
    opening_m: f64,
    wanted_m: f64,
    moved: bool,
}

impl StillWorld {
    /// A world whose block stands at `place` (x, y).
    pub fn with_block_at(place: [f64; 2]) -> Self {
        let hand = Hand { time_s: 0.0, opening_m: 0.03, wanted_m: 0.03, moved: false };
        let block = Point3::new(place[0], place[1], BLOCK_M);
        Self { hand: Mutex::new(hand), block }
    }

    fn change<R>(&self, change: impl FnOnce(&mut Hand) -> R) -> R {
        change(&mut self.hand.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl Default for StillWorld {
    /// The block half a metre in front.
    fn default() -> Self {
        Self::with_block_at([0.5, 0.0])
    }
}

impl World for StillWorld {
    fn state(&self) -> Result<WorldState, PluginError> {
        Ok(self.change(|hand| WorldState {
            time_s: hand.time_s,
            frame_s: FRAME_S,
            opening_m: hand.opening_m,
            fingers_move: hand.moved,
            pads_feel_load: false,
            load_n: Vector3::zeros(),
        }))
    }

    fn place_hand(&self, _: &Pose) -> Result<(), PluginError> {
        Ok(())
    }

    fn advance(&self, _: &Pose) -> Result<(), PluginError> {
        self.change(|hand| {
            let way = (hand.wanted_m - hand.opening_m).clamp(-FINGER_STEP_M, FINGER_STEP_M);
            hand.opening_m += way;
            hand.moved = way != 0.0;
            hand.time_s += FRAME_S;
        });
        Ok(())
    }

    fn close_fingers(&self, _: f64) -> Result<(), PluginError> {
        self.change(|hand| hand.wanted_m = 0.0);
        Ok(())
    }

    fn open_fingers(&self, opening_m: f64) -> Result<(), PluginError> {
        self.change(|hand| hand.wanted_m = opening_m);
        Ok(())
    }

    fn surfaces(&self) -> Result<Vec<Surface>, PluginError> {
        let table = cuboid(Point3::new(0.0, 0.0, -0.01), Vector3::new(2.0, 2.0, 0.01));
        let block = cuboid(self.block, Vector3::repeat(BLOCK_M));
        let surface = |mesh, is_object| Surface { mesh, is_object };
        Ok(vec![surface(table, false), surface(block, true)])
    }
}

/// A closed box about `centre`.
fn cuboid(centre: Point3<f64>, half: Vector3<f64>) -> TriangleMesh {
    let corner = |i: usize| {
        let sign = |bit: usize| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
        centre + half.component_mul(&Vector3::new(sign(0), sign(1), sign(2)))
    };
    let faces: [[u32; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    TriangleMesh::new((0..8).map(corner).collect(), triangles).expect("a box is a mesh")
}
