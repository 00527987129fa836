//! Stand-ins for what thinks.

use super::cap::canonical_cap;
use super::cell::{Behaviour, broken};
use nalgebra::Point3;
use seeone_core::robot::RobotModel;
use seeone_plugin::{
    Action, Candidate, CanonicalCloud, Encoding, Features, Field, IkOutcome, IkQuery,
    JointTrajectory, Kinematics, Motion, MotionOutcome, MotionTask, Observation, Perception,
    PluginError, Program, Step, Transfer, TransferTask,
};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Knows the canonical coordinates of the fake cap's points by their order.
pub(super) struct FakePerception(pub(super) Behaviour);

impl Perception for FakePerception {
    fn perceive(&mut self, observation: &Observation) -> Result<CanonicalCloud, PluginError> {
        broken(&self.0, "perceive")?;
        let nocs = canonical_cap();
        Ok(CanonicalCloud {
            points: observation.cloud.points().to_vec(),
            confidence: vec![[1.0; 3]; nocs.len()],
            features: vec![0.0; nocs.len()],
            feature_width: 1,
            nocs,
        })
    }
}

pub(super) struct FakeEncoding(pub(super) Behaviour);

struct Coordinates;

impl Field for Coordinates {
    fn features(&self, queries: &[Point3<f64>]) -> Features {
        let values =
            queries.iter().flat_map(|q| q.coords.iter().map(|v| *v as f32).collect::<Vec<_>>());
        Features { width: 3, values: values.collect() }
    }

    fn winding(&self, _: &[Point3<f64>]) -> Option<Vec<f64>> {
        None
    }
}

impl Encoding for FakeEncoding {
    fn encode(&mut self, _: &CanonicalCloud) -> Result<Box<dyn Field>, PluginError> {
        broken(&self.0, "encode")?;
        Ok(Box::new(Coordinates))
    }
}

/// The demonstrated grasp as it is.
pub(super) struct FakeTransfer(pub(super) Behaviour);

impl Transfer for FakeTransfer {
    fn transfer(&self, task: &TransferTask) -> Result<Vec<Candidate>, PluginError> {
        broken(&self.0, "transfer")?;
        let origin = "as demonstrated".into();
        Ok(vec![Candidate {
            pose: *task.demonstrated,
            loss: 0.0,
            confidence: 1.0,
            lay_on_surface: false,
            origin,
        }])
    }
}

pub(super) struct FakeKinematics;

impl Kinematics for FakeKinematics {
    fn solve(&self, _: &RobotModel, _: &IkQuery) -> Result<IkOutcome, PluginError> {
        Err(PluginError::Internal("nobody asks the fake kinematics".into()))
    }
}

/// One second for every line. Cheapest is the turn that points the tool downward most.
pub(super) struct FakeMotion(pub(super) Behaviour, pub(super) AtomicUsize);

impl Motion for FakeMotion {
    fn plan(
        &self,
        _: &RobotModel,
        _: &dyn Kinematics,
        task: &MotionTask,
    ) -> Result<MotionOutcome, PluginError> {
        broken(&self.0, "plan")?;
        if task.holding != (task.key_poses[0].stage != "pick") {
            return Err(PluginError::Internal(
                "only a plan from the start has an empty hand".into(),
            ));
        }
        let later = self.0.blocks_after.filter(|stage| task.key_poses[0].stage == *stage);
        let wanted = |stage: &&str| task.key_poses.iter().any(|key| key.stage == *stage);
        let refused = self.1.fetch_add(1, Ordering::Relaxed) < self.0.refuses;
        let refused = refused.then_some("pick");
        if let Some(stage) = self.0.unreachable.filter(wanted).or(later).or(refused) {
            let (stage, reason) = (stage.to_owned(), "0.30 m out of reach".to_owned());
            return Ok(MotionOutcome::Infeasible { stage, reason });
        }
        let mut steps = Vec::new();
        for key in task.key_poses {
            let line = Action::Move(JointTrajectory {
                period_s: 1.0,
                positions: vec![task.start.to_vec(); 2],
            });
            let mut step = |purpose, action| {
                steps.push(Step { stage: key.stage.clone(), purpose, action });
            };
            let approach = match (key.until_contact_n, &line) {
                (Some(force_n), Action::Move(trajectory)) => {
                    Action::MoveUntilContact { trajectory: trajectory.clone(), force_n }
                }
                _ => line.clone(),
            };
            step("approach", approach);
            if let Some(command) = key.gripper {
                step("grip", Action::Grip(command));
            }
            if key.lift_m > 0.0 {
                step("lift", line.clone());
            }
            if key.retreat_m > 0.0 {
                step("retreat", line);
            }
        }
        let cost = (task.key_poses[0].pose.rotation * nalgebra::Vector3::z()).z;
        Ok(MotionOutcome::Planned { program: Program { steps }, cost })
    }
}
