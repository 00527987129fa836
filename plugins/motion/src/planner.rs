//! The two plugins: walks around the key poses, transits between them, and their timing.

use crate::MotionConfig;
use crate::candidates::candidates;
use crate::checker::Checker;
use crate::hand::Hand;
use crate::rrt::distance;
use crate::timing::Timing;
use crate::transit::{Style, transit};
use crate::walk::{Deed, Fault, Walk, Walker};
use seeone_core::random::generator;
use seeone_core::robot::RobotModel;
use seeone_plugin::{
    Action, GripperCommand, IkQuery, JointTrajectory, KeyPose, Kinematics, Motion, MotionOutcome,
    MotionTask, PluginError, Program, Setup, Step,
};

/// Plans around obstacles.
pub struct Planner(Planning);

/// Moves straight in joint space between the key poses' lines, or refuses.
pub struct JointLine(Planning);

struct Planning {
    config: MotionConfig,
    seed: u64,
    style: Style,
}

impl Planner {
    /// A planner with options and the seed of its random trees.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for a number without meaning.
    pub fn new(config: MotionConfig, seed: u64) -> Result<Self, PluginError> {
        Ok(Self(Planning { config: config.checked()?, seed, style: Style::Planned }))
    }

    /// From a configuration table with the fields of [`MotionConfig`].
    ///
    /// # Errors
    /// [`PluginError::Configuration`] when the table is wrong.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        Self::new(setup.configuration()?, setup.seed)
    }
}

impl JointLine {
    /// A planner with options.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for a number without meaning.
    pub fn new(config: MotionConfig, seed: u64) -> Result<Self, PluginError> {
        Ok(Self(Planning { config: config.checked()?, seed, style: Style::Straight }))
    }

    /// From a configuration table with the fields of [`MotionConfig`].
    ///
    /// # Errors
    /// [`PluginError::Configuration`] when the table is wrong.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        Self::new(setup.configuration()?, setup.seed)
    }
}

impl Motion for Planner {
    fn plan(
        &self,
        robot: &RobotModel,
        kinematics: &dyn Kinematics,
        task: &MotionTask,
    ) -> Result<MotionOutcome, PluginError> {
        self.0.plan(robot, kinematics, task)
    }
}

impl Motion for JointLine {
    fn plan(
        &self,
        robot: &RobotModel,
        kinematics: &dyn Kinematics,
        task: &MotionTask,
    ) -> Result<MotionOutcome, PluginError> {
        self.0.plan(robot, kinematics, task)
    }
}

impl Planning {
    fn plan(
        &self,
        robot: &RobotModel,
        kinematics: &dyn Kinematics,
        task: &MotionTask,
    ) -> Result<MotionOutcome, PluginError> {
        check(robot, task)?;
        let plan = Plan { planning: self, robot, kinematics, task };
        Ok(match plan.solve()? {
            Ok((program, cost)) => MotionOutcome::Planned { program, cost },
            Err(Fault { stage, reason }) => MotionOutcome::Infeasible { stage, reason },
        })
    }
}

/// One task being planned.
struct Plan<'a> {
    planning: &'a Planning,
    robot: &'a RobotModel,
    kinematics: &'a dyn Kinematics,
    task: &'a MotionTask<'a>,
}

/// A run of key poses joined by lines, and the hand on the way to it.
struct Group<'a> {
    keys: &'a [KeyPose],
    hand: Hand,
    /// The command that brings the hand into that state, if it is not.
    prepare: Option<GripperCommand>,
}

impl<'a> Plan<'a> {
    fn solve(&self) -> Result<Result<(Program, f64), Fault>, PluginError> {
        let groups = self.groups();
        // Reach first: most tasks that fail do so here, and it is cheap.
        for group in &groups {
            if let Err(fault) = self.postures(group, self.task.start)? {
                return Ok(Err(fault));
            }
            for key in &group.keys[1..] {
                let near = self.task.start;
                let query = IkQuery { target: &key.pose, near, continuous: false };
                let outcome = self.kinematics.solve(self.robot, &query)?;
                if let Some(reason) = outcome.reason {
                    let (stage, reason) = (key.stage.clone(), format!("out of reach: {reason}"));
                    return Ok(Err(Fault { stage, reason }));
                }
            }
        }
        let mut at = self.task.start.to_vec();
        let mut program = Program::default();
        let mut cost = 0.0;
        for group in &groups {
            let (walk, path) = match self.enter(group, &at)? {
                Ok(found) => found,
                Err(fault) => return Ok(Err(fault)),
            };
            cost += walk.limit_cost
                + path.windows(2).map(|pair| distance(&pair[0], &pair[1])).sum::<f64>();
            at.clone_from(&walk.exit);
            self.write(&mut program, group, walk, &path);
        }
        Ok(Ok((program, cost)))
    }

    /// The best branch for a group on which its lines can be followed and which a transit
    /// reaches; with the transit.
    #[allow(clippy::type_complexity, reason = "a walk and the transit to it, or a fault")]
    fn enter(
        &self,
        group: &Group<'a>,
        at: &[f64],
    ) -> Result<Result<(Walk<'a>, Vec<Vec<f64>>), Fault>, PluginError> {
        let postures = match self.postures(group, at)? {
            Ok(postures) => postures,
            Err(fault) => return Ok(Err(fault)),
        };
        let walker = self.walker(group);
        let mut first_fault = None;
        for posture in postures {
            let fault = match walker.walk(&posture)? {
                Ok(walk) => match self.transit(group, at, &walk.entry) {
                    Ok(path) => return Ok(Ok((walk, path))),
                    Err(reason) => self.fault(group, &format!("transit: {reason}")),
                },
                Err(fault) => fault,
            };
            first_fault.get_or_insert(fault);
        }
        Ok(Err(first_fault.unwrap_or_else(|| self.fault(group, "no posture reaches it"))))
    }

    /// The postures in which the arm can stand at a group's first key pose.
    fn postures(
        &self,
        group: &Group<'a>,
        near: &[f64],
    ) -> Result<Result<Vec<Vec<f64>>, Fault>, PluginError> {
        let (pose, count) = (&group.keys[0].pose, self.planning.config.branches);
        let postures = match candidates(self.robot, self.kinematics, pose, near, count)? {
            Ok(postures) => postures,
            Err(reason) => return Ok(Err(self.fault(group, &format!("out of reach: {reason}")))),
        };
        let walker = self.walker(group);
        let mut why = None;
        let mut standing = Vec::with_capacity(postures.len());
        for posture in postures {
            match walker.stands(&posture) {
                Ok(()) => standing.push(posture),
                Err(reason) => _ = why.get_or_insert(reason),
            }
        }
        match why {
            Some(reason) if standing.is_empty() => {
                Ok(Err(self.fault(group, &format!("blocked at the pose: {reason}"))))
            }
            _ => Ok(Ok(standing)),
        }
    }

    fn transit(&self, group: &Group, start: &[f64], goal: &[f64]) -> Result<Vec<Vec<f64>>, String> {
        let planning = self.planning;
        let checker = Checker::new(self.robot, &planning.config, self.task.obstacles, &group.hand);
        let mut rng = generator(planning.seed, &format!("motion/{}", group.keys[0].stage));
        let ends = (start, goal);
        let (config, style, holding) = (&planning.config, planning.style, group.hand.holding);
        transit(self.robot, config, &checker, holding, style, ends, &mut rng)
    }

    /// The key poses in runs that straight lines join.
    fn groups(&self) -> Vec<Group<'a>> {
        let mut hand = Hand { opening_m: f64::NAN, holding: false };
        let mut groups: Vec<Group> = Vec::new();
        for keys in self.task.key_poses.chunk_by(Walker::joins) {
            let ready = hand.approaching(&keys[0]);
            let open = GripperCommand::Open { opening_m: ready.opening_m };
            let prepare = (ready != hand).then_some(open);
            groups.push(Group { keys, hand: ready, prepare });
            hand = keys.iter().fold(ready, |hand, key| hand.after(key.gripper));
        }
        groups
    }

    fn walker(&self, group: &Group<'a>) -> Walker<'a> {
        Walker {
            robot: self.robot,
            kinematics: self.kinematics,
            config: &self.planning.config,
            obstacles: self.task.obstacles,
            keys: group.keys,
            hand: group.hand,
        }
    }

    fn fault(&self, group: &Group, reason: &str) -> Fault {
        Fault { stage: group.keys[0].stage.clone(), reason: reason.to_owned() }
    }

    /// Appends a group's steps.
    fn write(&self, program: &mut Program, group: &Group, walk: Walk, path: &[Vec<f64>]) {
        let config = &self.planning.config;
        let timing = Timing { robot: self.robot, config };
        let mut push = |stage: &str, purpose, action| {
            program.steps.push(Step { stage: stage.to_owned(), purpose, action });
        };
        let first = &group.keys[0].stage;
        if let Some(command) = group.prepare {
            push(first, "grip", Action::Grip(command));
        }
        let holding = group.hand.holding;
        let speed = if holding { config.held_speed_m_s } else { config.transit_speed_m_s };
        push(first, "transit", Action::Move(timing.corners(path, speed)));
        for leg in walk.legs {
            let action = match leg.deed {
                Deed::Grip(command) => Action::Grip(command),
                Deed::Line { path, slow_start, slow_end } => {
                    Action::Move(self.line(&timing, &path, slow_start, slow_end))
                }
            };
            push(leg.stage, leg.purpose, action);
        }
    }

    /// Times a line, slow over its first or last stretch.
    fn line(
        &self,
        timing: &Timing,
        path: &[Vec<f64>],
        slow_start: bool,
        slow_end: bool,
    ) -> JointTrajectory {
        let config = &self.planning.config;
        let last = path.len() - 1;
        let near = ((config.near_m / config.line_step_m).ceil() as usize).min(last);
        let first_cut = if slow_start { near } else { 0 };
        let last_cut = if slow_end { (last - near).max(first_cut) } else { last };
        let pieces = [
            (&path[..=first_cut], config.near_speed_m_s),
            (&path[first_cut..=last_cut], config.line_speed_m_s),
            (&path[last_cut..], config.near_speed_m_s),
        ];
        let moving: Vec<_> = pieces.into_iter().filter(|(piece, _)| piece.len() > 1).collect();
        timing.line(&moving)
    }
}

/// # Errors
/// [`PluginError::Input`] for a task that cannot be worked on.
fn check(robot: &RobotModel, task: &MotionTask) -> Result<(), PluginError> {
    let told = |cause: String| Err(PluginError::Input(cause));
    if !robot.within_limits(task.start) {
        return told("the start must have one position within the limits for each joint".into());
    }
    for key in task.key_poses {
        let lengths = [key.approach_m, key.retreat_m, key.lift_m, key.opening_m];
        if !key.pose.to_homogeneous().iter().all(|v| v.is_finite()) {
            return told(format!("stage \"{}\": the pose is not finite", key.stage));
        }
        if !lengths.iter().all(|v| v.is_finite() && *v >= 0.0) {
            return told(format!("stage \"{}\": a length is negative or not finite", key.stage));
        }
    }
    Ok(())
}
