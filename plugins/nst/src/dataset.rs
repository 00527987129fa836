//! Training frames, each with the pose that best canonicalises it.

use crate::alignment::least_squares;
use crate::round::faced;
use nalgebra::Vector3;
use rand::RngExt;
use rayon::prelude::*;
use seeone_core::frames::{CanonicalObject, Frame, Index, Moment, read_all};
use seeone_core::random::{Generator, uniform};
use seeone_core::{Diagnostic, Similarity};
use std::path::Path;

/// Frames with fewer points show nothing that could be learnt.
pub const FEWEST_POINTS: usize = 64;
/// Largest share of draws that may show the object falling.
const FALLING_SHARE: f64 = 0.25;
/// Largest share of draws that may show it hanging from a gripper.
const HELD_SHARE: f64 = 0.2;

/// A frame and the least-squares pose of its object.
#[derive(Clone, Debug)]
pub struct AlignedFrame {
    /// The frame.
    pub frame: Frame,
    /// `world` -> centred canonical coordinates.
    pub alignment: Similarity,
}

/// Frames to train on.
#[derive(Clone, Debug)]
pub struct Dataset {
    frames: Vec<AlignedFrame>,
    settled: Vec<usize>,
    falling: Vec<usize>,
    held: Vec<usize>,
}

impl Dataset {
    /// Reads a set with its index.
    ///
    /// # Errors
    /// A located diagnostic when the set cannot be read or holds nothing to train on.
    pub fn read(folder: &Path) -> Result<(Self, Index), Diagnostic> {
        let (index, frames) = read_all(folder)?;
        let set = Self::new(frames, &index.objects).ok_or_else(|| {
            Diagnostic::new("N001", "the set holds no usable frame of an object at rest")
                .in_file(folder)
        })?;
        Ok((set, index))
    }

    /// Nothing when no frame shows an object at rest. A round object's frames are turned so
    /// that its front faces the camera.
    fn new(frames: Vec<Frame>, objects: &[CanonicalObject]) -> Option<Self> {
        let aligned = |frame: Frame| {
            let round = objects.get(frame.info.object).is_some_and(|o| o.round);
            let frame = aligned(frame)?;
            Some(if round { faced(frame) } else { frame })
        };
        let frames: Vec<AlignedFrame> = frames.into_par_iter().filter_map(aligned).collect();
        let seen = |moment: Moment| -> Vec<usize> {
            (0..frames.len()).filter(|i| frames[*i].frame.info.moment == moment).collect()
        };
        let (settled, falling) = (seen(Moment::Resting), seen(Moment::Falling));
        let held = seen(Moment::Held);
        (!settled.is_empty()).then_some(Self { frames, settled, falling, held })
    }

    /// All frames.
    pub fn frames(&self) -> &[AlignedFrame] {
        &self.frames
    }

    /// The number of a random frame of an object on the mat, at rest or falling.
    pub fn draw_on_mat(&self, rng: &mut Generator) -> usize {
        let on_mat = self.falling.len() + self.settled.len();
        let natural = self.falling.len() as f64 / on_mat as f64;
        let fall = uniform(rng, 0.0, 1.0) < natural.min(FALLING_SHARE);
        let from = if fall { &self.falling } else { &self.settled };
        from[rng.random_range(0..from.len())]
    }

    /// The number of a random frame, held in the gripper or on the mat.
    pub fn draw(&self, rng: &mut Generator) -> usize {
        let natural = self.held.len() as f64 / self.frames.len() as f64;
        if uniform(rng, 0.0, 1.0) < natural.min(HELD_SHARE) {
            self.held[rng.random_range(0..self.held.len())]
        } else {
            self.draw_on_mat(rng)
        }
    }
}

/// The frame with its pose; nothing when it has too few points or no pose.
pub fn aligned(frame: Frame) -> Option<AlignedFrame> {
    if frame.points.len() < FEWEST_POINTS {
        return None;
    }
    let from: Vec<Vector3<f64>> =
        frame.points.iter().map(|p| Vector3::from(p.map(f64::from))).collect();
    let to: Vec<Vector3<f64>> =
        frame.nocs.iter().map(|p| Vector3::from(p.map(|v| f64::from(v) - 0.5))).collect();
    let alignment = least_squares(&from, &to, &vec![1.0; from.len()])?;
    Some(AlignedFrame { frame, alignment })
}
