//! The two plugins: one search with either way to take a step.

use crate::IkConfig;
use crate::damped::Damped;
use crate::descent::{Step, Workspace};
use crate::quadratic::Quadratic;
use crate::search::Search;
use seeone_core::robot::RobotModel;
use seeone_plugin::{IkOutcome, IkQuery, Kinematics, PluginError, Setup};
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
        search.run(&mut workspace, self.seed);
        if query.clearance.is_some() && !search.is_solved() {
            // Then let it say what is in the way.
            search.keeps_apart = false;
            search.run(&mut workspace, self.seed);
        }
        self.give_back(workspace);
        Ok(search.outcome())
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
