//! Descent on the pose error from one start.

use crate::IkConfig;
use crate::linearised::{At, Linearised, PAIRS};
use nalgebra::DVector;
use seeone_core::Pose;
use seeone_core::pose::difference;
use seeone_core::robot::RobotModel;
use seeone_plugin::{IkQuery, Proximity};

/// The tolerance of the contract.
const POSITION_TOLERANCE_M: f64 = 1e-3;
/// The tolerance of the contract.
const ROTATION_TOLERANCE_RAD: f64 = 1e-2;
/// What the descent aims at, as a share of the tolerance: a path of such postures is
/// within 0.005 mm and 0.05 mrad of its poses.
const AIM: f64 = 0.005;
/// It gives up when the error has not fallen by a hundredth over this many steps.
const PATIENCE: usize = 8;
/// Pairs nearer than this bound the steps, metres.
const NEAR_M: f64 = 0.05;

/// Something that takes one step.
pub(crate) trait Step: Send {
    /// For an arm of `joints` joints and steps that know of `pairs` near pairs.
    fn new(config: &IkConfig, joints: usize, pairs: usize) -> Self;

    /// Puts the step in radians, within the problem's limits but for rounding, into `step`
    /// and says whether the numbers allowed one.
    fn step(&mut self, problem: &Linearised, step: &mut DVector<f64>) -> bool;
}

/// How far a posture's tool is from the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Miss {
    pub(crate) position_m: f64,
    pub(crate) rotation_rad: f64,
}

impl Miss {
    pub(crate) fn of(tool: &Pose, target: &Pose) -> Self {
        let (position_m, rotation_rad) = difference(tool, target);
        Self { position_m, rotation_rad }
    }

    /// The error in units of the tolerance.
    pub(crate) fn error(self) -> f64 {
        (self.position_m / POSITION_TOLERANCE_M).max(self.rotation_rad / ROTATION_TOLERANCE_RAD)
    }

    /// Whether it is within the tolerance.
    pub(crate) fn is_solved(self) -> bool {
        self.error() <= 1.0
    }
}

/// All memory of descents for arms of one size, used again by each.
pub(crate) struct Workspace<S> {
    step: S,
    problem: Linearised,
    pub(crate) links: Vec<Pose>,
    near: Vec<Proximity>,
    range: Vec<(f64, f64)>,
    at: Vec<f64>,
    delta: DVector<f64>,
    /// The best posture of the last descent, radians.
    pub(crate) best: Vec<f64>,
}

impl<S: Step> Workspace<S> {
    /// For a query of an arm of `joints` joints.
    pub(crate) fn new(config: &IkConfig, joints: usize, keeps_clear: bool) -> Self {
        let pairs = if keeps_clear { PAIRS } else { 0 };
        Self {
            step: S::new(config, joints, pairs),
            problem: Linearised::new(joints, pairs),
            links: Vec::with_capacity(joints + 1),
            near: Vec::new(),
            range: Vec::with_capacity(joints),
            at: Vec::with_capacity(joints),
            delta: DVector::zeros(joints),
            best: Vec::with_capacity(joints),
        }
    }

    /// Whether it is one that [`Self::new`] would make.
    pub(crate) fn fits(&self, joints: usize, keeps_clear: bool) -> bool {
        self.delta.len() == joints && self.problem.room.is_empty() != keeps_clear
    }

    /// Descends from `start`, which must be within the limits, and keeps near bodies apart if it
    /// shall; leaves the best posture met in [`Self::best`] and gives its miss and the number
    /// of steps.
    pub(crate) fn descend(
        &mut self,
        robot: &RobotModel,
        query: &IkQuery,
        start: &[f64],
        keeps_apart: bool,
        config: &IkConfig,
    ) -> (Miss, usize) {
        self.range.clear();
        self.range.extend(robot.joints().iter().zip(start).map(|(joint, q)| {
            let reach = query.period_s.map_or(f64::INFINITY, |period| joint.velocity() * period);
            (joint.lower().max(q - reach), joint.upper().min(q + reach))
        }));
        copy(&mut self.at, start);
        copy(&mut self.best, start);
        let mut miss = self.look(robot, query.target);
        let mut waited = 0;
        for iteration in 0..config.max_iterations {
            if miss.error() <= AIM || waited >= PATIENCE {
                return (miss, iteration);
            }
            self.near.clear();
            if let Some(clearance) = query.clearance.filter(|_| keeps_apart) {
                clearance.proximities(&self.at, NEAR_M, &mut self.near);
            }
            self.problem.set(&At {
                robot,
                q: &self.at,
                links: &self.links,
                target: query.target,
                posture: start,
                range: &self.range,
                step_rad: config.step_rad,
                near: &self.near,
            });
            if !self.step.step(&self.problem, &mut self.delta) {
                return (miss, iteration);
            }
            for (q, (delta, (low, high))) in
                self.at.iter_mut().zip(self.delta.iter().zip(&self.range))
            {
                *q = (*q + delta).clamp(*low, *high);
            }
            let here = self.look(robot, query.target);
            waited = if here.error() < 0.99 * miss.error() { 0 } else { waited + 1 };
            if here.error() < miss.error() {
                miss = here;
                copy(&mut self.best, &self.at);
            }
        }
        (miss, config.max_iterations)
    }

    /// Poses the links at [`Self::at`].
    fn look(&mut self, robot: &RobotModel, target: &Pose) -> Miss {
        robot.forward_into(&self.at, &mut self.links);
        Miss::of(&(self.links[self.at.len()] * robot.tool()), target)
    }
}

fn copy(to: &mut Vec<f64>, from: &[f64]) {
    to.clear();
    to.extend_from_slice(from);
}
