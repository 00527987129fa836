//! One task being planned: which branch of the arm for which key poses, and the transits
//! between them.

use crate::MotionConfig;
use crate::candidates::candidates;
use crate::failure::{Failure, StageFailure};
use crate::hand::Hand;
use crate::rrt::distance;
use crate::script::Script;
use crate::transit::{Style, transit};
use crate::walk::{Walk, Walker};
use seeone_collision::Convex;
use seeone_core::pose::difference;
use seeone_core::random::generator;
use seeone_core::robot::RobotModel;
use seeone_plugin::{GripperCommand, IkQuery, IkStatus, KeyPose, Kinematics, MotionTask, Program};

/// Branches for which a transit is searched before a group of key poses is given up: one
/// that cannot be found costs more than everything else.
const TRANSIT_SEARCHES: usize = 2;

/// An arm whose tool is this near to a pose stands there.
const HERE_M: f64 = 1e-6;
const HERE_RAD: f64 = 1e-6;

/// A task with all that is needed to plan it.
pub(crate) struct Plan<'a> {
    pub(crate) config: &'a MotionConfig,
    pub(crate) seed: u64,
    pub(crate) style: Style,
    pub(crate) robot: &'a RobotModel,
    pub(crate) kinematics: &'a dyn Kinematics,
    pub(crate) task: &'a MotionTask<'a>,
    /// The hull of what the hand takes, in the closed hand's tool frame.
    pub(crate) carried: Option<Convex>,
}

/// A run of key poses joined by lines, and the hand on the way to it.
struct Group<'a> {
    keys: &'a [KeyPose],
    hand: Hand,
    /// The command that brings the hand into that state, if it is not.
    prepare: Option<GripperCommand>,
}

impl Group<'_> {
    fn stage(&self) -> &str {
        &self.keys[0].stage
    }
}

impl<'a> Plan<'a> {
    /// The program and its cost.
    pub(crate) fn solve(&'a self) -> Result<(Program, f64), StageFailure> {
        let groups = self.groups();
        // Reach first: most tasks that fail do so here, and it is cheap.
        for group in &groups {
            self.postures(group, self.task.start)?;
            group.keys[1..].iter().try_for_each(|key| self.reach(key))?;
        }
        let mut at = self.task.start.to_vec();
        let mut script = Script::new(self.robot, self.config);
        let mut cost = 0.0;
        for group in &groups {
            let (path, walk) = self.enter(group, &at)?;
            cost += walk.limit_cost
                + path.windows(2).map(|pair| distance(&pair[0], &pair[1])).sum::<f64>();
            at.clone_from(&walk.exit);
            script.prepare(group.stage(), group.prepare);
            script.transit(group.stage(), &path, group.hand.holding);
            script.walk(walk);
        }
        Ok((script.program, cost))
    }

    /// The best branch for a group on which its lines can be followed, and the transit to
    /// its first posture.
    fn enter(
        &'a self,
        group: &Group<'a>,
        at: &[f64],
    ) -> Result<(Vec<Vec<f64>>, Walk<'a>), StageFailure> {
        let walker = self.walker(group);
        let mut searches = 0;
        let mut first_failure = None;
        for posture in self.postures(group, at)? {
            let entered = walker.walk(&posture).and_then(|walk| {
                searches += 1;
                if at == walk.entry {
                    return Ok((vec![at.to_vec()], walk));
                }
                self.transit(group, at, &walk.entry)
                    .map(|path| (path, walk))
                    .map_err(|failure| failure.at(group.stage(), "transit"))
            });
            match entered {
                Err(failure) if failure.is_infeasible() => first_failure.get_or_insert(failure),
                done => return done,
            };
            if searches == TRANSIT_SEARCHES {
                break;
            }
        }
        let none = || Failure::Infeasible("no posture is left".into()).at(group.stage(), "reach");
        Err(first_failure.unwrap_or_else(none))
    }

    /// The postures in which the arm can stand at a group's first key pose, at least one:
    /// that in which it stands there already, or all.
    fn postures(&'a self, group: &Group<'a>, near: &[f64]) -> Result<Vec<Vec<f64>>, StageFailure> {
        let (pose, count) = (&group.keys[0].pose, self.config.branches);
        let (distance_m, angle_rad) = difference(&self.robot.tool_pose(near), pose);
        if group.keys[0].approach_m == 0.0 && distance_m < HERE_M && angle_rad < HERE_RAD {
            return Ok(vec![near.to_vec()]);
        }
        let postures = candidates(self.robot, self.kinematics, pose, near, count)
            .map_err(|failure| failure.at(group.stage(), "out of reach"))?;
        let walker = self.walker(group);
        let mut why = None;
        let mut standing = Vec::with_capacity(postures.len());
        for posture in postures {
            match walker.stands(&posture) {
                Ok(()) => standing.push(posture),
                Err(failure) => _ = why.get_or_insert(failure),
            }
        }
        match why {
            Some(failure) if standing.is_empty() => {
                Err(failure.at(group.stage(), "blocked at the pose"))
            }
            _ => Ok(standing),
        }
    }

    /// Whether some posture reaches a key pose.
    fn reach(&self, key: &KeyPose) -> Result<(), StageFailure> {
        let query = IkQuery::new(&key.pose, self.task.start);
        let told = |failure: Failure| failure.at(&key.stage, "out of reach");
        let outcome = self.kinematics.solve(self.robot, &query).map_err(|e| told(e.into()))?;
        match outcome.status {
            IkStatus::Solved => Ok(()),
            IkStatus::Infeasible => {
                Err(told(Failure::Infeasible(outcome.reason.unwrap_or_default())))
            }
        }
    }

    fn transit(
        &'a self,
        group: &Group<'a>,
        start: &[f64],
        goal: &[f64],
    ) -> Result<Vec<Vec<f64>>, Failure> {
        let checker = self.walker(group).checker(&group.hand);
        let mut rng = generator(self.seed, &format!("motion/{}", group.stage()));
        transit(self.robot, self.config, &checker, self.style, (start, goal), &mut rng)
    }

    /// The key poses in runs that straight lines join.
    fn groups(&self) -> Vec<Group<'a>> {
        // How far empty fingers are open at first is not known; what is held is thin.
        let opening_m = if self.task.holding { 0.0 } else { f64::NAN };
        let mut hand = Hand { opening_m, holding: self.task.holding };
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

    fn walker(&'a self, group: &Group<'a>) -> Walker<'a> {
        Walker {
            robot: self.robot,
            kinematics: self.kinematics,
            config: self.config,
            obstacles: self.task.obstacles,
            carried: self.carried.as_ref(),
            keys: group.keys,
            hand: group.hand,
        }
    }
}
