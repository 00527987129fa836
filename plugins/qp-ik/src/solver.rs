//! The two plugins: starts, descents, and the choice among what they find.

use crate::damped::Damped;
use crate::descent::{Miss, Step, Workspace};
use crate::quadratic::Quadratic;
use crate::seeds::{Excess, Known};
use crate::{ClosedForm, IkConfig, reason, seeds};
use seeone_core::robot::RobotModel;
use seeone_plugin::{Contact, IkOutcome, IkQuery, IkStatus, Kinematics, PluginError, Setup};
use std::sync::{Mutex, PoisonError};

/// Inverse kinematics by quadratic programs (clarabel).
pub struct QpIk(Descents<Quadratic>);

/// Inverse kinematics by damped least squares.
pub struct DampedLeastSquares(Descents<Damped>);

struct Descents<S> {
    config: IkConfig,
    seed: u64,
    /// Workspaces that nobody is using. What was computed in one before changes no answer.
    spare: Mutex<Vec<Workspace<S>>>,
}

impl QpIk {
    /// A solver with options and the seed of its random starts.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for a number without meaning.
    pub fn new(config: IkConfig, seed: u64) -> Result<Self, PluginError> {
        Descents::new(config, seed).map(Self)
    }

    /// From a configuration table with the fields of [`IkConfig`].
    ///
    /// # Errors
    /// [`PluginError::Configuration`] when the table is wrong.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        Self::new(setup.configuration()?, setup.seed)
    }
}

impl DampedLeastSquares {
    /// A solver with options and the seed of its random starts.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for a number without meaning.
    pub fn new(config: IkConfig, seed: u64) -> Result<Self, PluginError> {
        Descents::new(config, seed).map(Self)
    }

    /// From a configuration table with the fields of [`IkConfig`].
    ///
    /// # Errors
    /// [`PluginError::Configuration`] when the table is wrong.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        Self::new(setup.configuration()?, setup.seed)
    }
}

impl Kinematics for QpIk {
    fn solve(&self, robot: &RobotModel, query: &IkQuery) -> Result<IkOutcome, PluginError> {
        self.0.solve(robot, query)
    }
}

impl Kinematics for DampedLeastSquares {
    fn solve(&self, robot: &RobotModel, query: &IkQuery) -> Result<IkOutcome, PluginError> {
        self.0.solve(robot, query)
    }
}

impl<S: Step> Descents<S> {
    fn new(config: IkConfig, seed: u64) -> Result<Self, PluginError> {
        Ok(Self { config: config.checked()?, seed, spare: Mutex::default() })
    }

    fn solve(&self, robot: &RobotModel, query: &IkQuery) -> Result<IkOutcome, PluginError> {
        query.check(robot)?;
        let mut workspace = self.take(robot.joints().len(), query.clearance.is_some());
        let mut search = Search::new(robot, query, &self.config);
        self.search(&mut workspace, &mut search);
        if query.clearance.is_some() && !search.is_solved() {
            // Then let it say what is in the way.
            search.keeps_apart = false;
            self.search(&mut workspace, &mut search);
        }
        self.give_back(workspace);
        Ok(search.outcome())
    }

    /// Descends from one start after the other until an answer touches nothing.
    fn search(&self, workspace: &mut Workspace<S>, search: &mut Search) {
        let (robot, query) = (search.robot, search.query);
        if query.continuous {
            search.start(workspace, query.near);
            return;
        }
        let geometry = if self.config.closed_form { ClosedForm::of(robot) } else { None };
        if let Some(geometry) = geometry {
            let known = seeds::closed_form(&geometry, robot, query.target, query.near);
            let Known { seeds, excess } = known;
            search.excess = if seeds.is_empty() { excess } else { None };
            // The closed form finds every solution there is; more starts would find no other.
            let ended = seeds.iter().any(|start| search.start(workspace, start));
            if !(ended || search.is_solved()) {
                search.start(workspace, query.near);
            }
        } else if !search.start(workspace, query.near) {
            let mut restarts = seeds::random(robot, self.seed, self.config.restarts);
            restarts.any(|start| search.start(workspace, &start));
        }
    }

    fn take(&self, joints: usize, keeps_clear: bool) -> Workspace<S> {
        let mut spare = self.spare.lock().unwrap_or_else(PoisonError::into_inner);
        match spare.iter().position(|workspace| workspace.fits(joints, keeps_clear)) {
            Some(index) => spare.swap_remove(index),
            None => Workspace::new(&self.config, joints, keeps_clear),
        }
    }

    fn give_back(&self, workspace: Workspace<S>) {
        self.spare.lock().unwrap_or_else(PoisonError::into_inner).push(workspace);
    }
}

/// What has been found so far.
struct Search<'a> {
    robot: &'a RobotModel,
    query: &'a IkQuery<'a>,
    config: &'a IkConfig,
    /// Whether descents keep near bodies apart.
    keeps_apart: bool,
    /// The best posture that is not solved, or is and touches nothing.
    best: Option<(Miss, Vec<f64>)>,
    /// The first solution that touches something, and what.
    touching: Option<(Miss, Vec<f64>, Contact)>,
    /// How many solutions touch something.
    touches: usize,
    /// Which limit keeps every exact solution away.
    excess: Option<Excess>,
    iterations: usize,
}

impl<'a> Search<'a> {
    fn new(robot: &'a RobotModel, query: &'a IkQuery<'a>, config: &'a IkConfig) -> Self {
        let (best, touching, excess) = (None, None, None);
        let (keeps_apart, touches, iterations) = (true, 0, 0);
        Self { robot, query, config, keeps_apart, best, touching, touches, excess, iterations }
    }

    /// Descends from `start` and says whether that ends the search.
    fn start<S: Step>(&mut self, workspace: &mut Workspace<S>, start: &[f64]) -> bool {
        let (miss, iterations) =
            workspace.descend(self.robot, self.query, start, self.keeps_apart, self.config);
        self.iterations += iterations;
        let found = &workspace.best;
        if miss.is_solved()
            && let Some(contact) = self.query.clearance.and_then(|c| c.contact(found))
        {
            self.touches += 1;
            self.touching.get_or_insert_with(|| (miss, found.clone(), contact));
            return false;
        }
        if self.best.as_ref().is_none_or(|(least, _)| miss.error() < least.error()) {
            self.best = Some((miss, found.clone()));
        }
        miss.is_solved()
    }

    fn is_solved(&self) -> bool {
        self.touching.is_some() || self.best.as_ref().is_some_and(|(miss, _)| miss.is_solved())
    }

    fn outcome(self) -> IkOutcome {
        let answer = |status, miss: Miss, joints, contact, reason| IkOutcome {
            status,
            joints,
            position_error_m: miss.position_m,
            rotation_error_rad: miss.rotation_rad,
            iterations: self.iterations,
            contact,
            reason,
        };
        match (self.best, self.touching) {
            (Some((miss, joints)), _) if miss.is_solved() => {
                answer(IkStatus::Solved, miss, joints, None, None)
            }
            (_, Some((miss, joints, contact))) => {
                let reason = reason::touching(&contact, self.touches);
                answer(IkStatus::Solved, miss, joints, Some(contact), Some(reason))
            }
            (Some((miss, joints)), None) => {
                let reason = reason::unsolved(self.robot, self.query, &joints, miss, self.excess);
                answer(IkStatus::Infeasible, miss, joints, None, Some(reason))
            }
            (None, None) => unreachable!("a search has at least one start"),
        }
    }
}
