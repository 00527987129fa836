//! One question: starts, descents, and the choice among what they find.

use crate::descent::{Miss, Step, Workspace};
use crate::rank::best_first;
use crate::seeds::{Bar, Known};
use crate::{ClosedForm, IkConfig, reason, seeds};
use seeone_core::robot::RobotModel;
use seeone_plugin::{Contact, IkOutcome, IkQuery, IkStatus};

/// Postures nearer than this are one solution, radians.
const SAME_RAD: f64 = 0.1;
/// Steps after the first solution that touches nothing at which the choice is made, however few there are:
/// a bound of time that reads no clock.
const GATHER_STEPS: usize = 200;

/// What has been found so far.
pub(crate) struct Search<'a> {
    robot: &'a RobotModel,
    query: &'a IkQuery<'a>,
    config: &'a IkConfig,
    /// Whether descents keep near bodies apart.
    pub(crate) keeps_apart: bool,
    /// The best posture that is not solved, or is and touches nothing.
    best: Option<Found>,
    /// The first solution that touches something, and what.
    touching: Option<(Found, Contact)>,
    /// How many solutions touch something.
    touches: usize,
    /// What keeps every exact solution away.
    bar: Option<Bar>,
    iterations: usize,
}

/// Where a descent ended.
struct Found {
    miss: Miss,
    /// Radians.
    joints: Vec<f64>,
}

impl Found {
    fn is_same(&self, other: &Self) -> bool {
        self.joints.iter().zip(&other.joints).all(|(a, b)| (a - b).abs() < SAME_RAD)
    }
}

impl AsRef<[f64]> for Found {
    fn as_ref(&self) -> &[f64] {
        &self.joints
    }
}

impl<'a> Search<'a> {
    pub(crate) fn new(robot: &'a RobotModel, query: &'a IkQuery<'a>, config: &'a IkConfig) -> Self {
        let (best, touching, bar) = (None, None, None);
        let (keeps_apart, touches, iterations) = (true, 0, 0);
        Self { robot, query, config, keeps_apart, best, touching, touches, bar, iterations }
    }

    /// Descends from one start after the other until an answer touches nothing. `seed` is that of
    /// the random starts.
    pub(crate) fn run<S: Step>(&mut self, workspace: &mut Workspace<S>, seed: u64) {
        let (robot, query) = (self.robot, self.query);
        if query.continuous {
            self.start(workspace, query.near);
            return;
        }
        match self.config.closed_form.then(|| ClosedForm::of(robot)).flatten() {
            Some(geometry) => self.known(workspace, &geometry),
            None => self.gathered(workspace, seed),
        }
    }

    /// From the closed form's solutions. It finds every solution there is; more starts would find
    /// no other.
    fn known<S: Step>(&mut self, workspace: &mut Workspace<S>, geometry: &ClosedForm) {
        let near = self.query.near;
        match seeds::closed_form(geometry, self.robot, self.query.target, near) {
            Known::Solutions(seeds) => {
                let ended = seeds.iter().any(|start| self.start(workspace, start));
                if ended || self.is_solved() {
                    return;
                }
            }
            Known::Barred(bar) => self.bar = Some(bar),
        }
        self.start(workspace, near);
    }

    /// From where the arm is and from random starts, until a few solutions that touch nothing are
    /// gathered.
    fn gathered<S: Step>(&mut self, workspace: &mut Workspace<S>, seed: u64) {
        let restarts = seeds::random(self.robot, self.query.near, seed, self.config.restarts);
        let (mut free, mut touching): (Vec<Found>, Vec<Found>) = (Vec::new(), Vec::new());
        let mut enough = usize::MAX;
        for start in std::iter::once(self.query.near.to_vec()).chain(restarts) {
            let found = self.descend(workspace, &start);
            if found.miss.is_solved() {
                let found = self.turned(found);
                if !free.iter().chain(&touching).any(|known| found.is_same(known)) {
                    let touches = self.contact(&found).is_some();
                    if touches { &mut touching } else { &mut free }.push(found);
                }
            } else {
                self.offer(found);
            }
            if free.len() == 1 {
                enough = enough.min(self.iterations + GATHER_STEPS);
            }
            if free.len() == self.config.solutions || self.iterations >= enough {
                break;
            }
        }
        for solutions in [free, touching] {
            let ranked = best_first(self.robot, self.query.near, solutions);
            if ranked.into_iter().any(|found| self.offer(found)) {
                return;
            }
        }
    }

    /// `found` with each joint at the whole turn nearest to where the arm is.
    fn turned(&self, found: Found) -> Found {
        match seeds::within_turns(self.robot, &found.joints, self.query.near) {
            Ok(joints) => Found { joints, ..found },
            Err(_) => found,
        }
    }

    /// Descends from `start` and says whether that ends the search.
    fn start<S: Step>(&mut self, workspace: &mut Workspace<S>, start: &[f64]) -> bool {
        let found = self.descend(workspace, start);
        self.offer(found)
    }

    fn descend<S: Step>(&mut self, workspace: &mut Workspace<S>, start: &[f64]) -> Found {
        let (miss, iterations) =
            workspace.descend(self.robot, self.query, start, self.keeps_apart, self.config);
        self.iterations += iterations;
        Found { miss, joints: workspace.best.clone() }
    }

    /// Keeps `found` if it is the best so far, and says whether that ends the search.
    fn offer(&mut self, found: Found) -> bool {
        let solved = found.miss.is_solved();
        if solved && let Some(contact) = self.contact(&found) {
            self.touches += 1;
            self.touching.get_or_insert((found, contact));
            return false;
        }
        if self.best.as_ref().is_none_or(|best| found.miss.error() < best.miss.error()) {
            self.best = Some(found);
        }
        solved
    }

    fn contact(&self, found: &Found) -> Option<Contact> {
        self.query.clearance.and_then(|clearance| clearance.contact(&found.joints))
    }

    pub(crate) fn is_solved(&self) -> bool {
        self.touching.is_some() || self.best.as_ref().is_some_and(|found| found.miss.is_solved())
    }

    pub(crate) fn outcome(mut self) -> IkOutcome {
        let best = self.best.take();
        let free = best.as_ref().is_some_and(|found| found.miss.is_solved());
        let (found, status, contact, reason) = match (best, self.touching.take()) {
            (Some(found), _) if free => (found, IkStatus::Solved, None, None),
            (_, Some((found, contact))) => {
                let reason = reason::touching(&contact, self.touches);
                (found, IkStatus::Solved, Some(contact), Some(reason))
            }
            (Some(found), None) => {
                let contact = self.contact(&found);
                let (robot, query) = (self.robot, self.query);
                let Found { miss, joints } = &found;
                let reason =
                    reason::unsolved(robot, query, joints, *miss, self.bar, contact.as_ref());
                (found, IkStatus::Infeasible, contact, Some(reason))
            }
            (None, None) => unreachable!("a search has at least one start"),
        };
        IkOutcome {
            status,
            joints: found.joints,
            position_error_m: found.miss.position_m,
            rotation_error_rad: found.miss.rotation_rad,
            iterations: self.iterations,
            contact,
            reason,
        }
    }
}
