//! Variations of a training frame that a new object or another view might show.

use crate::dataset::AlignedFrame;
use nalgebra::{Point3, Vector3};
use rand::RngExt;
use seeone_core::random::{Generator, uniform};

/// Largest change of the canonical proportions (width and height against length).
const PROPORTIONS: f64 = 0.04;
/// Share of samples in which a patch of points is hidden, and its largest radius (m).
const HIDDEN_SHARE: f64 = 0.3;
const HIDDEN_RADIUS_M: (f64, f64) = (0.015, 0.05);

/// Observed points (metres, `world`) with their centred canonical coordinates.
#[derive(Clone, Debug, Default)]
pub struct Sample {
    /// Observed points.
    pub points: Vec<Vector3<f64>>,
    /// `nocs - 0.5` of each.
    pub targets: Vec<Vector3<f64>>,
}

/// `count` points of `frame` in random order: of other proportions, and now and then with a
/// patch hidden. With fewer points than `count`, points repeat.
///
/// Proportions change in the canonical frame, where the longest edge (visor to back) keeps
/// its length, so that the result is a frame of another object of the category.
pub fn draw(frame: &AlignedFrame, count: usize, rng: &mut Generator) -> Sample {
    let stretch = Vector3::new(
        uniform(rng, 1.0 - PROPORTIONS, 1.0 + PROPORTIONS),
        1.0,
        uniform(rng, 1.0 - PROPORTIONS, 1.0 + PROPORTIONS),
    );
    let rows = shuffled_rows(frame, count, rng);
    let back = frame.alignment.inverse();
    let mut sample = Sample::default();
    for row in rows {
        let canonical = frame.alignment.transform_point(&point(frame, row));
        let stretched = Point3::from(canonical.coords.component_mul(&stretch));
        sample.points.push(back.transform_point(&stretched).coords);
        let nocs = Vector3::from(frame.frame.nocs[row].map(f64::from)) - Vector3::repeat(0.5);
        sample.targets.push(nocs.component_mul(&stretch));
    }
    sample
}

fn point(frame: &AlignedFrame, row: usize) -> Point3<f64> {
    Point3::from(frame.frame.points[row].map(f64::from))
}

fn shuffled_rows(frame: &AlignedFrame, count: usize, rng: &mut Generator) -> Vec<usize> {
    let all = frame.frame.points.len();
    let mut rows: Vec<usize> = (0..all).collect();
    if uniform(rng, 0.0, 1.0) < HIDDEN_SHARE {
        let centre = point(frame, rng.random_range(0..all));
        let radius = uniform(rng, HIDDEN_RADIUS_M.0, HIDDEN_RADIUS_M.1);
        rows.retain(|row| (point(frame, *row) - centre).norm() > radius);
        if rows.len() < all / 2 {
            rows = (0..all).collect(); // hardly anything would be left of a small view
        }
    }
    take_shuffled(&mut rows, count, rng)
}

/// The first `count` of `rows` after shuffling (Fisher and Yates); with fewer rows, every
/// row and then repetitions.
pub fn take_shuffled(rows: &mut [usize], count: usize, rng: &mut Generator) -> Vec<usize> {
    let distinct = count.min(rows.len());
    for i in 0..distinct {
        let j = rng.random_range(i..rows.len());
        rows.swap(i, j);
    }
    let mut taken = rows[..distinct].to_vec();
    while taken.len() < count {
        taken.push(rows[rng.random_range(0..rows.len())]);
    }
    taken
}
