//! Figures on frames with known canonical coordinates.

use crate::dataset::aligned;
use crate::inference::{MOST_POINTS, Nst, Perceived};
use crate::round::nearest;
use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use rayon::prelude::*;
use seeone_core::Similarity;
use seeone_core::frames::{CanonicalObject, Frame, Moment};
use seeone_core::random::{Generator, direction, generator, normal};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Points nearer than this to the mirror plane (canonical units) have no clear side.
const NO_SIDE: f64 = 0.1;
/// A pose that is farther off than this is lost, degrees.
pub const LOST_DEG: f64 = 30.0;

/// How far off a hand's knowledge of what it holds may be: deviations of a turn (rad) and of
/// each coordinate (canonical units, some 0.27 m).
const GRIP_TURN_RAD: f64 = 0.2;
const GRIP_SHIFT: f64 = 0.05;

/// Shares of confidence that are told apart in a reliability diagram.
pub const CONFIDENCE_BINS: usize = 10;
/// A vertex of the canonical mesh with an observed point this near (canonical units) is seen.
const SEEN: f64 = 0.04;

/// Points whose confidence lies in one tenth of `[0, 1]`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ConfidenceBin {
    /// Points.
    pub points: usize,
    /// Sum of their confidences, each the product over three coordinates.
    pub confidence: f64,
    /// How many have an error below 0.1 d.
    pub within_01_d: usize,
}

/// How good the answers on one frame are, in counts of points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FrameFigures {
    /// Index of the object in the set.
    pub object: usize,
    /// What the object was doing.
    pub moment: Moment,
    /// Share of the object's vertices that were seen.
    pub visible: f64,
    /// Whether nothing could be perceived.
    pub refused: bool,
    /// Points.
    pub points: usize,
    /// Error below 0.04 d.
    pub within_004_d: usize,
    /// Error below 0.1 d.
    pub within_01_d: usize,
    /// Off the mirror plane.
    pub sided: usize,
    /// Of those, nearer to their mirror image.
    pub mirrored: usize,
    /// Angle between the fitted pose and the true fit, degrees.
    pub turned_deg: f64,
    /// Mean confidence of the points.
    pub confidence: f64,
    /// The same by tenths.
    pub bins: [ConfidenceBin; CONFIDENCE_BINS],
}

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

impl Group {
    /// The figures of `frames` together, each point counting the same.
    pub fn of<'a>(frames: impl Iterator<Item = &'a FrameFigures> + Clone) -> Self {
        let sum = |of: fn(&FrameFigures) -> usize| frames.clone().map(of).sum::<usize>();
        let share = |part: usize, of: usize| part as f64 / of.max(1) as f64;
        let (count, points) = (frames.clone().count(), sum(|f| f.points));
        Self {
            frames: count,
            refused: sum(|f| f.refused.into()),
            within_004_d: share(sum(|f| f.within_004_d), points),
            within_01_d: share(sum(|f| f.within_01_d), points),
            mirrored: share(sum(|f| f.mirrored), sum(|f| f.sided)),
            over_30_degrees: share(sum(|f| (f.turned_deg > LOST_DEG).into()), count),
        }
    }
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

impl Figures {
    /// Of all frames.
    pub fn of(frames: &[FrameFigures]) -> Self {
        let of = |moment| Group::of(frames.iter().filter(move |f| f.moment == moment));
        Self { settled: of(Moment::Resting), falling: of(Moment::Falling), held: of(Moment::Held) }
    }
}

/// Perceives every frame and compares with the truth. `objects` are those of the frames'
/// set. Frames too small to have a true pose are left out; the turn of round objects is
/// taken out. A held object is perceived from a start that is off by what a hand does not
/// know of its grip.
pub fn evaluate(nst: &Nst, objects: &[CanonicalObject], frames: &[Frame]) -> Vec<FrameFigures> {
    let truths: Vec<Option<Truth<'_>>> = objects.par_iter().map(Truth::new).collect();
    let figures = |(number, frame): (usize, &Frame)| {
        let truth = truths.get(frame.info.object)?.as_ref()?;
        judge(nst, frame, truth, &mut generator(number as u64, "held start"))
    };
    frames.par_iter().enumerate().filter_map(figures).collect()
}

/// What is known of an object.
struct Truth<'a> {
    object: &'a CanonicalObject,
    diameter: f64,
}

impl<'a> Truth<'a> {
    fn new(object: &'a CanonicalObject) -> Option<Self> {
        Some(Self { object, diameter: object.mesh().ok()?.diameter() })
    }

    /// Share of the vertices that have one of `nocs` nearby.
    fn visible(&self, nocs: &[[f32; 3]]) -> f64 {
        let cell = |p: [f64; 3]| p.map(|v| (v / SEEN).floor() as i32);
        let mut cells: BTreeMap<[i32; 3], Vec<[f64; 3]>> = BTreeMap::new();
        for p in nocs {
            let p = p.map(f64::from);
            cells.entry(cell(p)).or_default().push(p);
        }
        let near = |v: &[f64; 3], p: &[f64; 3]| {
            (0..3).map(|k| (v[k] - p[k]).powi(2)).sum::<f64>() < SEEN * SEEN
        };
        let seen = |v: &&[f64; 3]| {
            let at = cell(**v);
            (0..27).any(|n: i32| {
                let around = [at[0] + n % 3 - 1, at[1] + n / 3 % 3 - 1, at[2] + n / 9 - 1];
                cells.get(&around).is_some_and(|points| points.iter().any(|p| near(v, p)))
            })
        };
        let vertices = &self.object.vertices;
        vertices.iter().filter(seen).count() as f64 / vertices.len().max(1) as f64
    }
}

fn judge(nst: &Nst, frame: &Frame, known: &Truth<'_>, rng: &mut Generator) -> Option<FrameFigures> {
    let mut truth = aligned(frame.clone())?;
    let points: Vec<Point3<f64>> =
        frame.points.iter().map(|p| Point3::from(p.map(f64::from))).collect();
    let nothing = FrameFigures {
        object: frame.info.object,
        moment: frame.info.moment,
        visible: known.visible(&frame.nocs),
        refused: true,
        points: points.len().min(MOST_POINTS),
        within_004_d: 0,
        within_01_d: 0,
        sided: 0,
        mirrored: 0,
        turned_deg: 180.0,
        confidence: 0.0,
        bins: Default::default(),
    };
    let camera = Point3::from(frame.info.camera.xyz_m);
    let perceived = if frame.info.moment == Moment::Held {
        nst.perceive_from(&points, &camera, &known_to_the_hand(&truth.alignment, rng))
    } else {
        nst.perceive(&points, &camera)
    };
    let Ok(perceived) = perceived else { return Some(nothing) };
    if known.object.round {
        truth = nearest(truth, &perceived.rows, &perceived.nocs);
    }
    let angle = perceived.alignment.isometry.rotation.angle_to(&truth.alignment.isometry.rotation);
    let told =
        FrameFigures { refused: false, points: 0, turned_deg: angle.to_degrees(), ..nothing };
    Some(compared(told, &perceived, &truth.frame, known.diameter))
}

/// The true alignment, off by as much as a grip was.
fn known_to_the_hand(truth: &Similarity, rng: &mut Generator) -> Similarity {
    let turn = UnitQuaternion::from_scaled_axis(direction(rng) * (GRIP_TURN_RAD * normal(rng)));
    let shift = Vector3::from_fn(|_, _| GRIP_SHIFT * normal(rng));
    Similarity::from_parts(Translation3::from(shift), turn, 1.0) * truth
}

/// Counts every point of `perceived` into `figures`.
fn compared(
    mut figures: FrameFigures,
    perceived: &Perceived,
    frame: &Frame,
    diameter: f64,
) -> FrameFigures {
    let told = perceived.rows.iter().zip(&perceived.nocs).zip(&perceived.confidence);
    for ((row, nocs), confidence) in told {
        let truth = Vector3::from(frame.nocs[*row].map(f64::from));
        let mirrored = Vector3::new(1.0 - truth.x, truth.y, truth.z);
        let error = (nocs.coords - truth).norm();
        let near = error < 0.1 * diameter;
        figures.points += 1;
        figures.within_004_d += usize::from(error < 0.04 * diameter);
        figures.within_01_d += usize::from(near);
        if (truth.x - 0.5).abs() > NO_SIDE {
            figures.sided += 1;
            figures.mirrored += usize::from((nocs.coords - mirrored).norm() < error);
        }
        let confidence: f64 = confidence.iter().product();
        let tenth = (confidence * CONFIDENCE_BINS as f64) as usize;
        let bin = &mut figures.bins[tenth.min(CONFIDENCE_BINS - 1)];
        bin.points += 1;
        bin.confidence += confidence;
        bin.within_01_d += usize::from(near);
        figures.confidence += confidence;
    }
    figures.confidence /= figures.points.max(1) as f64;
    figures
}
