//! Figures on frames with known canonical coordinates.

use crate::dataset::aligned;
use crate::inference::{Nst, Perceived};
use crate::round::nearest;
use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use rayon::prelude::*;
use seeone_core::Similarity;
use seeone_core::frames::{CanonicalObject, Frame, Moment};
use seeone_core::random::{Generator, direction, generator, normal};
use serde::{Deserialize, Serialize};

/// Points nearer than this to the mirror plane (canonical units) have no clear side.
const NO_SIDE: f64 = 0.1;

/// How far off a hand's knowledge of what it holds may be: deviations of a turn (rad) and of
/// each coordinate (canonical units, some 0.27 m).
const GRIP_TURN_RAD: f64 = 0.2;
const GRIP_SHIFT: f64 = 0.05;

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
/// set. Frames too small to have a true pose are left out; the turn of round objects is
/// taken out. A held object is perceived from a start that is off by what a hand does not
/// know of its grip.
pub fn evaluate(nst: &Nst, objects: &[CanonicalObject], frames: &[Frame]) -> Figures {
    let diameters: Vec<f64> =
        objects.par_iter().map(|o| o.mesh().map_or(1.0, |mesh| mesh.diameter())).collect();
    let tally = |moment: Moment| {
        frames
            .par_iter()
            .enumerate()
            .filter(|(_, f)| f.info.moment == moment)
            .filter_map(|(number, frame)| {
                let (object, diameter) =
                    (objects.get(frame.info.object)?, *diameters.get(frame.info.object)?);
                let mut rng = generator(number as u64, "held start");
                judge(nst, frame, object.round, diameter, &mut rng)
            })
            .reduce(Tally::default, Tally::add)
            .group()
    };
    Figures {
        settled: tally(Moment::Resting),
        falling: tally(Moment::Falling),
        held: tally(Moment::Held),
    }
}

fn judge(
    nst: &Nst,
    frame: &Frame,
    round: bool,
    diameter: f64,
    rng: &mut Generator,
) -> Option<Tally> {
    let mut truth = aligned(frame.clone())?;
    let points: Vec<Point3<f64>> =
        frame.points.iter().map(|p| Point3::from(p.map(f64::from))).collect();
    let perceived = if frame.info.moment == Moment::Held {
        nst.perceive_from(&points, &known_to_the_hand(&truth.alignment, rng))
    } else {
        nst.perceive(&points, &Point3::from(frame.info.camera.xyz_m))
    };
    let Ok(perceived) = perceived else {
        let refused =
            Tally { frames: 1, refused: 1, points: points.len(), turned: 1, ..Tally::default() };
        return Some(refused);
    };
    if round {
        truth = nearest(truth, &perceived.rows, &perceived.nocs);
    }
    let angle = perceived.alignment.isometry.rotation.angle_to(&truth.alignment.isometry.rotation);
    let mut tally = compare(&perceived, &truth.frame, diameter);
    tally.turned = usize::from(angle.to_degrees() > 30.0);
    Some(tally)
}

/// The true alignment, off by as much as a grip was.
fn known_to_the_hand(truth: &Similarity, rng: &mut Generator) -> Similarity {
    let turn = UnitQuaternion::from_scaled_axis(direction(rng) * (GRIP_TURN_RAD * normal(rng)));
    let shift = Vector3::from_fn(|_, _| GRIP_SHIFT * normal(rng));
    Similarity::from_parts(Translation3::from(shift), turn, 1.0) * truth
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
