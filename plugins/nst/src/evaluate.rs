//! Figures on frames with known canonical coordinates.

use crate::dataset::aligned;
use crate::inference::{Nst, Perceived};
use nalgebra::{Point3, Vector3};
use rayon::prelude::*;
use seeone_core::frames::{CanonicalObject, Frame, Moment};
use serde::{Deserialize, Serialize};

/// Points nearer than this to the mirror plane (canonical units) have no clear side.
const NO_SIDE: f64 = 0.1;

/// How good the answers on a group of frames are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Group {
    /// Frames.
    pub frames: usize,
    /// Frames on which nothing could be perceived; their points count as wrong.
    pub refused: usize,
    /// Share of points with an error below 0.04 d (method: Acc_nocs).
    pub within_004_d: f64,
    /// Share of points with an error below 0.1 d.
    pub within_01_d: f64,
    /// Share of points off the mirror plane that lie nearer their mirror image.
    pub mirrored: f64,
    /// Share of frames whose fitted pose is more than 30 degrees off the true fit.
    pub over_30_degrees: f64,
}

/// Figures of objects at rest, of falling ones and of held ones, apart.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Figures {
    /// At rest: what the robot sees.
    pub settled: Group,
    /// Still falling.
    pub falling: Group,
    /// Hanging from a gripper.
    pub held: Group,
}

/// Counts of one frame.
#[derive(Clone, Copy, Default)]
struct Tally {
    frames: usize,
    refused: usize,
    points: usize,
    near: usize,
    far: usize,
    sided: usize,
    mirrored: usize,
    turned: usize,
}

impl Tally {
    fn add(self, other: Self) -> Self {
        Self {
            frames: self.frames + other.frames,
            refused: self.refused + other.refused,
            points: self.points + other.points,
            near: self.near + other.near,
            far: self.far + other.far,
            sided: self.sided + other.sided,
            mirrored: self.mirrored + other.mirrored,
            turned: self.turned + other.turned,
        }
    }

    fn group(self) -> Group {
        let share = |part: usize, of: usize| part as f64 / of.max(1) as f64;
        Group {
            frames: self.frames,
            refused: self.refused,
            within_004_d: share(self.near, self.points),
            within_01_d: share(self.far, self.points),
            mirrored: share(self.mirrored, self.sided),
            over_30_degrees: share(self.turned, self.frames),
        }
    }
}

/// Perceives every frame and compares with the truth. `objects` are those of the frames'
/// set. Frames too small to have a true pose are left out.
pub fn evaluate(nst: &Nst, objects: &[CanonicalObject], frames: &[Frame]) -> Figures {
    let diameters: Vec<f64> =
        objects.par_iter().map(|o| o.mesh().map_or(1.0, |mesh| mesh.diameter())).collect();
    let tally = |moment: Moment| {
        frames
            .par_iter()
            .filter(|f| f.info.moment == moment)
            .filter_map(|frame| judge(nst, frame, *diameters.get(frame.info.object)?))
            .reduce(Tally::default, Tally::add)
            .group()
    };
    Figures {
        settled: tally(Moment::Resting),
        falling: tally(Moment::Falling),
        held: tally(Moment::Held),
    }
}

fn judge(nst: &Nst, frame: &Frame, diameter: f64) -> Option<Tally> {
    let truth = aligned(frame.clone())?;
    let points: Vec<Point3<f64>> =
        frame.points.iter().map(|p| Point3::from(p.map(f64::from))).collect();
    let camera = Point3::from(frame.info.camera.xyz_m);
    let Ok(perceived) = nst.perceive(&points, &camera) else {
        let refused =
            Tally { frames: 1, refused: 1, points: points.len(), turned: 1, ..Tally::default() };
        return Some(refused);
    };
    let angle = perceived.alignment.isometry.rotation.angle_to(&truth.alignment.isometry.rotation);
    let mut tally = compare(&perceived, frame, diameter);
    tally.turned = usize::from(angle.to_degrees() > 30.0);
    Some(tally)
}

fn compare(perceived: &Perceived, frame: &Frame, diameter: f64) -> Tally {
    let mut tally = Tally { frames: 1, ..Tally::default() };
    for (row, nocs) in perceived.rows.iter().zip(&perceived.nocs) {
        let truth = Vector3::from(frame.nocs[*row].map(f64::from));
        let mirrored = Vector3::new(1.0 - truth.x, truth.y, truth.z);
        let error = (nocs.coords - truth).norm();
        tally.points += 1;
        tally.near += usize::from(error < 0.04 * diameter);
        tally.far += usize::from(error < 0.1 * diameter);
        if (truth.x - 0.5).abs() > NO_SIDE {
            tally.sided += 1;
            tally.mirrored += usize::from((nocs.coords - mirrored).norm() < error);
        }
    }
    tally
}
