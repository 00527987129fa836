//! Training frames, each with the pose that best canonicalises it.

use crate::alignment::least_squares;
use nalgebra::Vector3;
use rand::RngExt;
use rayon::prelude::*;
use seeone_core::frames::{Frame, Index, Moment, read_all};
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
        let set = Self::new(frames).ok_or_else(|| {
            Diagnostic::new("N001", "the set holds no usable frame of an object at rest")
                .in_file(folder)
        })?;
        Ok((set, index))
    }

    /// From frames; nothing when no frame shows an object at rest.
    pub fn new(frames: Vec<Frame>) -> Option<Self> {
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

    /// The number of a random frame.
    pub fn draw(&self, rng: &mut Generator) -> usize {
        let natural = |some: &[usize]| some.len() as f64 / self.frames.len() as f64;
        let falling = natural(&self.falling).min(FALLING_SHARE);
        let held = natural(&self.held).min(HELD_SHARE);
        let from = match uniform(rng, 0.0, 1.0) {
            draw if draw < falling => &self.falling,
            draw if draw < falling + held => &self.held,
            _ => &self.settled,
        };
        from[rng.random_range(0..from.len())]
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
