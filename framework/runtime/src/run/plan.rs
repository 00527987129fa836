//! From grasps to a program: the best grasp that the robot can carry through to the end.

use super::act::Acted;
use super::assignment::Assignment;
use super::bench::Bench;
use super::hull::Hull;
use super::key_poses::{Askew, righting, shown};
use super::observe::Seen;
use super::schedule::leave;
use super::step::{Failed, Step};
use super::transfer::{Grasp, Transferred};
use crate::plugins::Plugins;
use crate::transfer::{TILTS_DEG, Turn, turns};
use bevy_ecs::prelude::*;
use nalgebra::Point3;
use seeone_plugin::{KeyPose, MotionOutcome, MotionTask, Program};

/// The most grasps that are tried: they differ by millimetres, so what is out of reach for
/// several is for all.
const MOST_GRASPS: usize = 3;
/// The whole retreat may be out of reach: so much of it is tried, one after the other.
pub(super) const RETREAT_SHARES: [f64; 5] = [1.0, 0.75, 0.5, 0.2, 0.1];

/// After each time that the hand closed on nothing, it opens wider by so much of what was shown:
/// what it should have taken was not between the pads, but is not far from them.
const WIDER: f64 = 0.5;

/// What the robot shall do.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct Planned {
    /// Index of the chosen grasp in [`Transferred::grasps`].
    pub grasp: usize,
    /// How it was turned.
    pub turn: Turn,
    /// The key poses.
    pub key_poses: Vec<KeyPose>,
    /// The outermost points of what was seen of the object, where they will be in the closed
    /// hand's tool frame once it is taken.
    pub carried: Vec<Point3<f64>>,
    /// The program through them.
    pub program: Program,
    /// Its cost, for comparison alone.
    pub cost: f64,
}

/// What a plan is made of: a run, and what the robot did in it before, if it is not the first try.
type ToPlan = (
    Entity,
    &'static Assignment,
    &'static Seen,
    &'static Transferred,
    Option<&'static Acted>,
    Option<&'static Askew>,
);

pub(super) fn plan(
    mut commands: Commands,
    mut bench: NonSendMut<Bench>,
    runs: Query<ToPlan, Without<Failed>>,
) {
    for (run, assignment, seen, transferred, acted, askew) in &runs {
        let hull = Hull::of(&seen.0.cloud);
        let opening_m = opening(assignment, acted.map_or(0, |acted| acted.missed));
        let planned = bench.step(Step::Plan, |plugins| {
            let mut search = Search { plugins, assignment, transferred, opening_m };
            let by_what_was_shown = |grasp: &Grasp, turn: &Turn| {
                let key_poses = shown(assignment, transferred, grasp, turn);
                let carried = hull.in_the_hand(&key_poses);
                Some((key_poses, carried))
            };
            // What is set right touches what it lies on all the way: it keeps away from nothing.
            let righted = askew.map(|askew| {
                search.planned(&|grasp: &Grasp, turn: &Turn| {
                    Some((righting(assignment, grasp, turn, *askew)?, Vec::new()))
                })
            });
            match righted {
                Some(Ok(planned)) => Ok(planned),
                _ => search.planned(&by_what_was_shown),
            }
        });
        commands.entity(run).remove::<Askew>();
        leave(&mut commands, run, planned);
    }
}

/// How wide the hand is open as it comes to take the object that it has `missed` so often.
fn opening(assignment: &Assignment, missed: usize) -> f64 {
    let shown_m = assignment.skill.stages[0].opening_m;
    let widest_m = assignment.robot.gripper().stroke_m();
    (shown_m * (1.0 + WIDER * missed as f64)).min(widest_m.max(shown_m))
}

/// The key poses of a way to take the object, and what the hand then carries.
type Way = (Vec<KeyPose>, Vec<Point3<f64>>);

/// What a program is looked for with.
struct Search<'a> {
    plugins: &'a mut Plugins,
    assignment: &'a Assignment,
    transferred: &'a Transferred,
    /// How wide the hand is open as it comes.
    opening_m: f64,
}

impl Search<'_> {
    /// A program by the smallest tilt and with as much of the retreats as will do.
    fn planned(&mut self, way: &dyn Fn(&Grasp, &Turn) -> Option<Way>) -> Result<Planned, String> {
        let mut refused = String::new();
        let shares = |tilt_deg| RETREAT_SHARES.map(|share| (tilt_deg, share));
        for (tilt_deg, share) in TILTS_DEG.into_iter().flat_map(shares) {
            match self.with_retreats(way, tilt_deg, share)? {
                Ok(planned) => return Ok(planned),
                // What stands in the way of the whole retreats says most.
                Err(reason) if refused.is_empty() => refused = reason,
                Err(_) => {}
            }
        }
        Err(refused)
    }

    /// The first grasp that has any way, turned as little as will do, by the cheapest program:
    /// the less the hand is turned, the nearer it takes the object to how it was shown. Of every
    /// retreat it makes `share`. When there is no way: why.
    fn with_retreats(
        &mut self,
        way: &dyn Fn(&Grasp, &Turn) -> Option<Way>,
        tilt_deg: f64,
        share: f64,
    ) -> Result<Result<Planned, String>, String> {
        let Self { plugins, assignment, transferred, opening_m } = self;
        let start = plugins.robot.state().map_err(|e| e.to_string())?.joints;
        let obstacles = assignment.scene.obstacles();
        let turns = turns(assignment.skill.stages[0].turn_about_closing_deg, tilt_deg);
        let mut nearest: Option<(usize, String)> = None;
        let grasps = &transferred.grasps[..transferred.grasps.len().min(MOST_GRASPS)];
        for (index, grasp) in grasps.iter().enumerate() {
            let mut best: Option<Planned> = None;
            for turn in &turns {
                let shown = |best: &Planned| best.turn.about_closing_deg.abs();
                if best.as_ref().is_some_and(|best| turn.about_closing_deg.abs() > shown(best)) {
                    break;
                }
                let Some((mut key_poses, carried)) = way(grasp, turn) else { continue };
                key_poses[0].opening_m = *opening_m;
                key_poses.iter_mut().for_each(|key| key.retreat_m *= share);
                let task = MotionTask {
                    start: &start,
                    holding: false,
                    carried: &carried,
                    key_poses: &key_poses,
                    obstacles: &obstacles,
                };
                let outcome = plugins
                    .motion
                    .plan(&assignment.robot, plugins.kinematics.as_ref(), &task)
                    .map_err(|e| e.to_string())?;
                match outcome {
                    MotionOutcome::Planned { program, cost } => {
                        if best.as_ref().is_none_or(|best| cost < best.cost) {
                            let (grasp, turn) = (index, *turn);
                            best = Some(Planned { grasp, turn, key_poses, carried, program, cost });
                        }
                    }
                    MotionOutcome::Infeasible { stage, reason } => {
                        let reached = key_poses.iter().position(|k| k.stage == stage).unwrap_or(0);
                        if nearest.as_ref().is_none_or(|(furthest, _)| reached > *furthest) {
                            nearest = Some((reached, format!("{stage}: {reason}")));
                        }
                    }
                }
            }
            if let Some(best) = best {
                return Ok(Ok(best));
            }
        }
        let tried = grasps.len() * turns.len();
        let nearest = nearest.map_or_else(String::new, |(_, reason)| reason);
        let reason = "ways to grasp can be carried out; the nearest fails at";
        Ok(Err(format!("none of {tried} {reason} {nearest}")))
    }
}
