//! The two plugins: starts, descents, and the choice among what they find.

use crate::damped::Damped;
use crate::descent::{Posture, Step, descend};
use crate::quadratic::QuadraticProgram;
use crate::{ClosedForm, IkConfig, seeds};
use seeone_core::robot::RobotModel;
use seeone_plugin::{IkOutcome, IkQuery, IkStatus, Kinematics, PluginError, Setup};

/// Inverse kinematics by quadratic programs (clarabel).
pub struct QpIk(Descents<QuadraticProgram>);

/// Inverse kinematics by damped least squares.
pub struct DampedLeastSquares(Descents<Damped>);

struct Descents<S> {
    config: IkConfig,
    step: S,
    seed: u64,
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
        let config = config.checked()?;
        Ok(Self { step: S::new(&config), config, seed })
    }

    fn solve(&self, robot: &RobotModel, query: &IkQuery) -> Result<IkOutcome, PluginError> {
        let near = checked(robot, query)?;
        let mut search = Search { best: None, iterations: 0 };
        if query.continuous {
            self.try_start(robot, query, &near, &mut search);
            return Ok(search.outcome(robot, &near, query));
        }
        let geometry = if self.config.closed_form { ClosedForm::of(robot) } else { None };
        let known = geometry.as_ref();
        let known = known.map_or(vec![], |g| seeds::closed_form(g, robot, query.target, &near));
        for start in known.iter().chain([&near]) {
            if self.try_start(robot, query, start, &mut search) {
                return Ok(search.outcome(robot, &near, query));
            }
        }
        // The closed form finds every solution there is; more starts would find no other.
        let restarts = if geometry.is_some() { 0 } else { self.config.restarts };
        for start in seeds::random(robot, self.seed, restarts) {
            if self.try_start(robot, query, &start, &mut search) {
                break;
            }
        }
        Ok(search.outcome(robot, &near, query))
    }

    /// Descends from `start` and says whether that solved it.
    fn try_start(
        &self,
        robot: &RobotModel,
        query: &IkQuery,
        start: &[f64],
        search: &mut Search,
    ) -> bool {
        let (found, iterations) = descend(robot, query.target, start, &self.step, &self.config);
        search.iterations += iterations;
        let solved = found.error() <= 1.0;
        if search.best.as_ref().is_none_or(|best| found.error() < best.error()) {
            search.best = Some(found);
        }
        solved
    }
}

/// What has been found so far.
struct Search {
    best: Option<Posture>,
    iterations: usize,
}

impl Search {
    fn outcome(self, robot: &RobotModel, near: &[f64], query: &IkQuery) -> IkOutcome {
        let best = self.best.unwrap_or_else(|| Posture::new(robot, near.to_vec(), query.target));
        let solved = best.error() <= 1.0;
        IkOutcome {
            status: if solved { IkStatus::Solved } else { IkStatus::Infeasible },
            position_error_m: best.position_error_m,
            rotation_error_rad: best.rotation_error_rad,
            iterations: self.iterations,
            reason: (!solved).then(|| reason(robot, &best, query.continuous)),
            joints: best.joints,
        }
    }
}

fn reason(robot: &RobotModel, best: &Posture, continuous: bool) -> String {
    let millimetres = 1e3 * best.position_error_m;
    let degrees = best.rotation_error_rad.to_degrees();
    let branch = if continuous { " on this branch" } else { "" };
    let joints = robot.joints().iter().zip(&best.joints);
    let stuck: Vec<&str> = joints
        .filter(|(joint, q)| (*q - joint.lower()).min(joint.upper() - *q) < 1e-3)
        .map(|(joint, _)| joint.name())
        .collect();
    let limits = match stuck.as_slice() {
        [] => String::new(),
        names => format!(", with {} at the limit", names.join(", ")),
    };
    format!(
        "the nearest posture{branch} is {millimetres:.1} mm and {degrees:.1} degrees off{limits}"
    )
}

/// The start moved within the limits.
fn checked(robot: &RobotModel, query: &IkQuery) -> Result<Vec<f64>, PluginError> {
    let told = |cause: String| Err(PluginError::Input(cause));
    if !query.target.to_homogeneous().iter().all(|v| v.is_finite()) {
        return told("the target pose is not finite".into());
    }
    let (given, wanted) = (query.near.len(), robot.joints().len());
    if given != wanted {
        return told(format!("the start has {given} positions, the arm {wanted} joints"));
    }
    if !query.near.iter().all(|v| v.is_finite()) {
        return told("the start is not finite".into());
    }
    let joints = robot.joints().iter().zip(query.near);
    Ok(joints.map(|(joint, q)| q.clamp(joint.lower(), joint.upper())).collect())
}
