//! Where a shell was, so that a list of what is near is looked up anew only after motion.

use nalgebra::Point3;
use seeone_core::Pose;

/// The vertices at one moment, in the frame that moves about as the whole shell does: rigid
/// motion brings no two of them nearer.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    /// Empty before the first time.
    vertices: Vec<Point3<f64>>,
}

impl Snapshot {
    /// Remembers `position` under `frame` (shell -> world).
    pub fn take(&mut self, position: &[Point3<f64>], frame: &Pose) {
        self.vertices.clear();
        self.vertices.extend(position.iter().map(inverse(frame)));
    }

    /// How far a vertex has moved since in `frame` (shell -> world), metres, at most; infinite
    /// before the first time.
    pub fn moved_m(&self, position: &[Point3<f64>], frame: &Pose) -> f64 {
        if self.vertices.len() != position.len() {
            return f64::INFINITY;
        }
        self.squares(position, frame).fold(0.0, f64::max).sqrt()
    }

    /// Tells of each vertex whether it has moved farther than `limit_m` since, as all have
    /// before the first time. Answers how many.
    pub fn mark_moved(
        &self,
        position: &[Point3<f64>],
        frame: &Pose,
        limit_m: f64,
        marks: &mut Vec<bool>,
    ) -> usize {
        marks.clear();
        if self.vertices.len() == position.len() {
            marks.extend(self.squares(position, frame).map(|square| square > limit_m * limit_m));
        } else {
            marks.resize(position.len(), true);
        }
        marks.iter().filter(|moved| **moved).count()
    }

    fn squares(&self, position: &[Point3<f64>], frame: &Pose) -> impl Iterator<Item = f64> {
        let back = inverse(frame);
        let moved = position.iter().zip(&self.vertices).map(move |(now, then)| back(now) - then);
        moved.map(|m| m.norm_squared())
    }
}

/// World -> frame.
fn inverse(frame: &Pose) -> impl Fn(&Point3<f64>) -> Point3<f64> {
    let turn = frame.rotation.inverse().to_rotation_matrix();
    let shift = turn * -frame.translation.vector;
    move |p| turn * p + shift
}
