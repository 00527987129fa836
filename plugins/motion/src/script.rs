//! Writes down what has been planned, with its timing.

use crate::MotionConfig;
use crate::timing::Timing;
use crate::walk::{Deed, Walk};
use seeone_core::robot::RobotModel;
use seeone_plugin::{Action, GripperCommand, JointTrajectory, Program, Step};

/// A program being written.
pub(crate) struct Script<'a> {
    pub(crate) program: Program,
    timing: Timing<'a>,
}

impl<'a> Script<'a> {
    pub(crate) fn new(robot: &'a RobotModel, config: &'a MotionConfig) -> Self {
        Self { program: Program::default(), timing: Timing { robot, config } }
    }

    /// Brings the fingers to where they must be on the way.
    pub(crate) fn prepare(&mut self, stage: &str, command: Option<GripperCommand>) {
        if let Some(command) = command {
            self.push(stage, "grip", Action::Grip(command));
        }
    }

    /// A move in free space along straight lines in joint space.
    pub(crate) fn transit(&mut self, stage: &str, path: &[Vec<f64>], holding: bool) {
        if path.len() < 2 {
            return;
        }
        let config = self.timing.config;
        let speed = if holding { config.held_speed_m_s } else { config.transit_speed_m_s };
        self.push(stage, "transit", Action::Move(self.timing.corners(path, speed)));
    }

    /// The lines and grips around key poses.
    pub(crate) fn walk(&mut self, walk: Walk) {
        for leg in walk.legs {
            let action = match leg.deed {
                Deed::Grip(command) => Action::Grip(command),
                Deed::Line { path, slow_start, slow_end } => {
                    Action::Move(self.line(&path, slow_start, slow_end))
                }
                Deed::Guarded { path, force_n } => {
                    let speed = self.timing.config.guarded_speed_m_s;
                    let trajectory = self.timing.line(&[(&path, speed)]);
                    Action::MoveUntilContact { trajectory, force_n }
                }
            };
            self.push(leg.stage, leg.purpose, action);
        }
    }

    /// Times a line, slow over its first or last stretch.
    fn line(&self, path: &[Vec<f64>], slow_start: bool, slow_end: bool) -> JointTrajectory {
        let config = self.timing.config;
        let last = path.len() - 1;
        let tool = |q: &Vec<f64>| self.timing.robot.tool_pose(q).translation.vector;
        let near = |end: &Vec<f64>| {
            let end = tool(end);
            path.iter().filter(|q| tool(q).metric_distance(&end) <= config.near_m).count()
        };
        let first_cut = if slow_start { near(&path[0]).min(last) } else { 0 };
        let last_cut =
            if slow_end { last.saturating_sub(near(&path[last])).max(first_cut) } else { last };
        let pieces = [
            (&path[..=first_cut], config.near_speed_m_s),
            (&path[first_cut..=last_cut], config.line_speed_m_s),
            (&path[last_cut..], config.near_speed_m_s),
        ];
        let moving: Vec<_> = pieces.into_iter().filter(|(piece, _)| piece.len() > 1).collect();
        self.timing.line(&moving)
    }

    fn push(&mut self, stage: &str, purpose: &'static str, action: Action) {
        self.program.steps.push(Step { stage: stage.to_owned(), purpose, action });
    }
}
