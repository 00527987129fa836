//! Kind `motion`: key poses -> a program of joint trajectories and grips.

use crate::{GripperCommand, Kinematics, PluginError};
use nalgebra::{Point3, UnitQuaternion, Vector3};
use seeone_core::Pose;
use seeone_core::robot::{RobotModel, Solid};

/// A gripper pose that the skill passes through, with what happens around it.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyPose {
    /// The stage's name.
    pub stage: String,
    /// Tool frame (TCP) in `world`.
    pub pose: Pose,
    /// Straight approach along the tool's z before the pose, metres; zero for none.
    pub approach_m: f64,
    /// Opening of the fingers while approaching, metres.
    pub opening_m: f64,
    /// The straight line to the pose ends where the load at the wrist has changed by this
    /// since the line began, newtons; the pose is then as far as it may go.
    pub until_contact_n: Option<f64>,
    /// What the gripper does there.
    pub gripper: Option<GripperCommand>,
    /// Straight retreat against the tool's z after it, metres; zero for none.
    pub retreat_m: f64,
    /// Straight lift along the world's z after it, metres; zero for none.
    pub lift_m: f64,
}

/// What the arm must not touch.
#[derive(Clone, Debug, PartialEq)]
pub enum Obstacle {
    /// The half-space below `height_m` (world z), with a soft cover into which the
    /// robot may sink by `soft_m`.
    Table {
        /// Top of the cover, metres.
        height_m: f64,
        /// How far the robot may sink into it, metres.
        soft_m: f64,
    },
    /// An ellipsoid, e.g. a head.
    Ellipsoid {
        /// Its name in reasons.
        name: String,
        /// Its centre in `world`.
        centre: Point3<f64>,
        /// Its orientation in `world`.
        rotation: UnitQuaternion<f64>,
        /// Its semi-axes, metres.
        semi_axes_m: Vector3<f64>,
    },
    /// A box, cylinder, capsule or ball, e.g. a shelf or the stand of a camera; its `part` is
    /// its name in reasons, its pose is in `world`.
    Solid(Solid),
}

/// One planning problem.
#[derive(Clone, Copy, Debug)]
pub struct MotionTask<'a> {
    /// Where the joints are, radians.
    pub start: &'a [f64],
    /// Whether something is in the hand.
    pub holding: bool,
    /// Points of what is in the hand, or will be once it has closed, in the closed hand's tool
    /// frame, metres: their convex hull keeps away from what it is not brought to on purpose.
    /// None where nobody knows.
    pub carried: &'a [Point3<f64>],
    /// The key poses, in order.
    pub key_poses: &'a [KeyPose],
    /// What must not be touched.
    pub obstacles: &'a [Obstacle],
}

impl MotionTask<'_> {
    /// Refuses what no planner can work on, so that every implementation refuses alike.
    ///
    /// # Errors
    /// [`PluginError::Input`] for a start of the wrong length or outside the limits, for what is
    /// carried with a point that is none, and for a key pose with a pose, length, force or
    /// opening that is none.
    pub fn check(&self, robot: &RobotModel) -> Result<(), PluginError> {
        let told = |cause: String| Err(PluginError::Input(cause));
        if !robot.within_limits(self.start) {
            return told(
                "the start must have one position within the limits for each joint".into(),
            );
        }
        if !self.carried.iter().all(|point| point.iter().all(|v| v.is_finite())) {
            return told("a point of what is carried is not finite".into());
        }
        for key in self.key_poses {
            let lengths = [key.approach_m, key.retreat_m, key.lift_m, key.opening_m];
            if !key.pose.to_homogeneous().iter().all(|v| v.is_finite()) {
                return told(format!("stage \"{}\": the pose is not finite", key.stage));
            }
            if !lengths.iter().all(|v| v.is_finite() && *v >= 0.0) {
                return told(format!(
                    "stage \"{}\": a length is negative or not finite",
                    key.stage
                ));
            }
            if key.until_contact_n.is_some_and(|force| !(force.is_finite() && force > 0.0)) {
                return told(format!("stage \"{}\": the force of contact is no force", key.stage));
            }
            let commanded = match key.gripper {
                Some(GripperCommand::Open { opening_m }) => opening_m,
                Some(GripperCommand::Close { .. }) | None => 0.0,
            };
            let stroke = robot.gripper().stroke_m();
            if !commanded.is_finite() || key.opening_m.max(commanded) > stroke {
                let stage = &key.stage;
                return told(format!("stage \"{stage}\": the gripper opens by {stroke} m at most"));
            }
        }
        Ok(())
    }
}

/// Joint positions at equal steps of time; starts and ends at rest.
#[derive(Clone, Debug, PartialEq)]
pub struct JointTrajectory {
    /// Seconds between samples (0.008 for a CB3's 125 Hz).
    pub period_s: f64,
    /// Samples: radians, one a joint.
    pub positions: Vec<Vec<f64>>,
}

impl JointTrajectory {
    /// Says what `robot` cannot follow.
    ///
    /// # Errors
    /// A sentence about a trajectory without samples or period, or a sample that has not one
    /// finite position within the limits for each joint.
    pub fn check(&self, robot: &RobotModel) -> Result<(), String> {
        positive("sample period", self.period_s)?;
        if self.positions.is_empty() {
            return Err("a trajectory has no samples".into());
        }
        for (i, sample) in self.positions.iter().enumerate() {
            if sample.len() != robot.joints().len() {
                return Err(format!("sample {i} has {} joints", sample.len()));
            }
            for (position, joint) in sample.iter().zip(robot.joints()) {
                let low = joint.lower() - LIMIT_TOLERANCE_RAD;
                let high = joint.upper() + LIMIT_TOLERANCE_RAD;
                if !(low..=high).contains(position) {
                    let name = joint.name();
                    return Err(format!("sample {i} takes {name} to {position:.3} rad"));
                }
            }
        }
        Ok(())
    }

    /// Refuses what `robot`, whose joints are at `joints` in radians, cannot follow from there,
    /// so that every robot refuses alike.
    ///
    /// # Errors
    /// [`PluginError::Input`] as [`Self::check`], and for a first sample that is further than
    /// `tolerance_rad` from `joints`.
    pub fn check_from(
        &self,
        robot: &RobotModel,
        joints: &[f64],
        tolerance_rad: f64,
    ) -> Result<(), PluginError> {
        self.check(robot).map_err(PluginError::Input)?;
        let first = self.positions[0].iter().zip(joints);
        let jump = first.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        if jump > tolerance_rad {
            let told = format!("the trajectory starts {jump:.3} rad from where the arm is");
            return Err(PluginError::Input(told));
        }
        Ok(())
    }

    /// How long it takes, seconds.
    pub fn duration_s(&self) -> f64 {
        self.period_s * self.positions.len().saturating_sub(1) as f64
    }

    /// Joint positions at `time_s`, linear between samples and held beyond the ends;
    /// `None` when there is no sample.
    pub fn at(&self, time_s: f64) -> Option<Vec<f64>> {
        let last = self.positions.len().checked_sub(1)?;
        let exact = (time_s / self.period_s).clamp(0.0, last as f64);
        let (from, part) = (exact.floor() as usize, exact.fract());
        let next = &self.positions[(from + 1).min(last)];
        Some(self.positions[from].iter().zip(next).map(|(a, b)| a + part * (b - a)).collect())
    }
}

/// One thing the robot does.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Follow a joint trajectory.
    Move(JointTrajectory),
    /// Follow a joint trajectory until the load at the wrist has changed by `force_n` since
    /// it began, and stop there.
    MoveUntilContact {
        /// How far it goes at most.
        trajectory: JointTrajectory,
        /// Newtons.
        force_n: f64,
    },
    /// Open or close the gripper.
    Grip(GripperCommand),
}

/// What a step can be for.
pub const PURPOSES: [&str; 5] = ["approach", "grip", "lift", "transit", "retreat"];

/// An action and the stage it belongs to.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The stage's name, as in the skill file.
    pub stage: String,
    /// What it is for: one of [`PURPOSES`].
    pub purpose: &'static str,
    /// What is done.
    pub action: Action,
}

/// What the robot shall do, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    /// The steps.
    pub steps: Vec<Step>,
}

impl Program {
    /// Time of all its trajectories, seconds.
    pub fn duration_s(&self) -> f64 {
        self.steps
            .iter()
            .map(|step| match &step.action {
                Action::Move(trajectory) | Action::MoveUntilContact { trajectory, .. } => {
                    trajectory.duration_s()
                }
                Action::Grip(_) => 0.0,
            })
            .sum()
    }
}

/// What a planner found.
#[derive(Clone, Debug, PartialEq)]
pub enum MotionOutcome {
    /// A program within the robot's limits that touches nothing.
    Planned {
        /// The program.
        program: Program,
        /// Smaller is better: joint travel and closeness to limits; for choosing among
        /// equivalent grasps.
        cost: f64,
    },
    /// There is none.
    Infeasible {
        /// The stage that cannot be reached.
        stage: String,
        /// Why, with numbers.
        reason: String,
    },
}

/// A planned position may be beyond a limit by rounding only, radians.
const LIMIT_TOLERANCE_RAD: f64 = 1e-6;

impl MotionOutcome {
    /// Says what no planner may answer for `robot`.
    ///
    /// # Errors
    /// A sentence about a trajectory without samples, period or the robot's joints, a position
    /// that is not within the limits, a number that is not finite, or a refusal without a
    /// reason.
    pub fn check(&self, robot: &RobotModel) -> Result<(), String> {
        let (program, cost) = match self {
            MotionOutcome::Planned { program, cost } => (program, cost),
            MotionOutcome::Infeasible { stage, reason } if reason.trim().is_empty() => {
                return Err(format!("there is no way to \"{stage}\", and no reason is given"));
            }
            MotionOutcome::Infeasible { .. } => return Ok(()),
        };
        if !cost.is_finite() {
            return Err(format!("the cost is {cost}"));
        }
        for (i, step) in program.steps.iter().enumerate() {
            let sound = match &step.action {
                Action::Move(trajectory) => trajectory.check(robot),
                Action::MoveUntilContact { trajectory, force_n } => {
                    trajectory.check(robot).and_then(|()| positive("force", *force_n))
                }
                Action::Grip(GripperCommand::Close { force_n }) => positive("force", *force_n),
                Action::Grip(GripperCommand::Open { opening_m }) if *opening_m == 0.0 => Ok(()),
                Action::Grip(GripperCommand::Open { opening_m }) => positive("opening", *opening_m),
            };
            sound.map_err(|cause| format!("step {i} ({}): {cause}", step.purpose))?;
        }
        Ok(())
    }
}

fn positive(what: &str, number: f64) -> Result<(), String> {
    let sound = number.is_finite() && number > 0.0;
    if sound { Ok(()) } else { Err(format!("the {what} is {number}")) }
}

/// Key poses -> program.
pub trait Motion: Send + Sync {
    /// Plans one task.
    ///
    /// # Errors
    /// [`PluginError::Input`] for a start of the wrong length or outside the limits, or
    /// poses that are not finite; the error of the kinematics, which are asked no more after it.
    fn plan(
        &self,
        robot: &RobotModel,
        kinematics: &dyn Kinematics,
        task: &MotionTask,
    ) -> Result<MotionOutcome, PluginError>;
}
