//! Messages of kind `motion`.

use super::{Remote, kinematics, robot};
use crate::abi::callee::{Callee, Foreign, missing, not_answered};
use crate::abi::cells::{Put, Reader, Take, fields, malformed, message};
use crate::abi::methods::Method;
use crate::motion::{Obstacle, PURPOSES};
use crate::{KeyPose, Kinematics, Motion, MotionOutcome, MotionTask, PluginError, Program, Step};
use nalgebra::Point3;
use seeone_core::robot::{RobotModel, Shape, Solid};
use std::sync::Arc;

/// A task that has crossed, without the kinematics, which are lent.
struct Task {
    robot: Option<RobotModel>,
    start: Vec<f64>,
    holding: bool,
    carried: Vec<Point3<f64>>,
    key_poses: Vec<KeyPose>,
    obstacles: Vec<Obstacle>,
}

fields!(Task { robot, start, holding, carried, key_poses, obstacles });
fields!(KeyPose {
    stage,
    pose,
    approach_m,
    opening_m,
    until_contact_n,
    gripper,
    retreat_m,
    lift_m,
});
fields!(Solid { part, shape, pose });
fields!(Program { steps });

/// 0 and half edges, 1 radius and length of a cylinder, 2 of a capsule, 3 and a radius.
impl Put for Shape {
    fn put(&self, to: &mut Vec<u64>) {
        match *self {
            Shape::Box { half_m } => (0u64, half_m).put(to),
            Shape::Cylinder { radius_m, length_m } => (1u64, (radius_m, length_m)).put(to),
            Shape::Capsule { radius_m, length_m } => (2u64, (radius_m, length_m)).put(to),
            Shape::Sphere { radius_m } => (3u64, radius_m).put(to),
        }
    }
}

impl Take for Shape {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        let kind = u64::take(from)?;
        match kind {
            0 => Ok(Shape::Box { half_m: Take::take(from)? }),
            1 | 2 => {
                let (radius_m, length_m) = Take::take(from)?;
                Ok(if kind == 1 {
                    Shape::Cylinder { radius_m, length_m }
                } else {
                    Shape::Capsule { radius_m, length_m }
                })
            }
            3 => Ok(Shape::Sphere { radius_m: Take::take(from)? }),
            other => Err(malformed(format!("there is no shape {other}"))),
        }
    }
}

/// 0 height and softness of a table, 1 name, centre, rotation and semi-axes of an ellipsoid, 2
/// name, shape and pose of a solid.
impl Put for Obstacle {
    fn put(&self, to: &mut Vec<u64>) {
        match self {
            Obstacle::Table { height_m, soft_m } => (0u64, (*height_m, *soft_m)).put(to),
            Obstacle::Ellipsoid { name, centre, rotation, semi_axes_m } => {
                1u64.put(to);
                name.put(to);
                centre.put(to);
                rotation.put(to);
                semi_axes_m.put(to);
            }
            Obstacle::Solid(solid) => {
                2u64.put(to);
                solid.put(to);
            }
        }
    }
}

impl Take for Obstacle {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        match u64::take(from)? {
            0 => {
                let (height_m, soft_m) = Take::take(from)?;
                Ok(Obstacle::Table { height_m, soft_m })
            }
            1 => Ok(Obstacle::Ellipsoid {
                name: Take::take(from)?,
                centre: Take::take(from)?,
                rotation: Take::take(from)?,
                semi_axes_m: Take::take(from)?,
            }),
            2 => Ok(Obstacle::Solid(Take::take(from)?)),
            other => Err(malformed(format!("there is no obstacle {other}"))),
        }
    }
}

impl Put for Step {
    fn put(&self, to: &mut Vec<u64>) {
        self.stage.put(to);
        self.purpose.put(to);
        self.action.put(to);
    }
}

impl Take for Step {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        let (stage, purpose) = <(String, String)>::take(from)?;
        let known = PURPOSES.into_iter().find(|known| *known == purpose);
        let purpose = known.ok_or_else(|| malformed(format!("no step is for \"{purpose}\"")))?;
        Ok(Self { stage, purpose, action: Take::take(from)? })
    }
}

impl Put for MotionOutcome {
    fn put(&self, to: &mut Vec<u64>) {
        match self {
            MotionOutcome::Planned { program, cost } => {
                true.put(to);
                program.put(to);
                cost.put(to);
            }
            MotionOutcome::Infeasible { stage, reason } => {
                false.put(to);
                stage.put(to);
                reason.put(to);
            }
        }
    }
}

impl Take for MotionOutcome {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        if bool::take(from)? {
            let (program, cost) = Take::take(from)?;
            Ok(MotionOutcome::Planned { program, cost })
        } else {
            let (stage, reason) = Take::take(from)?;
            Ok(MotionOutcome::Infeasible { stage, reason })
        }
    }
}

impl<C: Callee> Motion for Remote<C> {
    fn plan(
        &self,
        robot: &RobotModel,
        kinematics: &dyn Kinematics,
        task: &MotionTask,
    ) -> Result<MotionOutcome, PluginError> {
        let MotionTask { start, holding, carried, key_poses, obstacles } = *task;
        let sent = self.unknown(robot);
        let request = message(&[&sent, &start, &holding, &carried, &key_poses, &obstacles]);
        let lent = KinematicsCallee { kinematics, robot: self.shared(robot) };
        let sound = |outcome: &MotionOutcome| outcome.check(robot);
        self.ask(Method::Plan, &request, &[&lent], sound)
    }
}

/// Kinematics that are lent to plan for one robot.
struct KinematicsCallee<'a> {
    kinematics: &'a dyn Kinematics,
    robot: Arc<RobotModel>,
}

impl Callee for KinematicsCallee<'_> {
    fn call(
        &self,
        method: Method,
        request: &[u64],
        lent: &[&dyn Callee],
    ) -> Result<Vec<u64>, PluginError> {
        kinematics::served(self.kinematics, Some(&self.robot), method, request, lent)
    }
}

/// Answers with `plugin`, which knows the robot of its setup.
pub(in crate::abi) fn served(
    plugin: &dyn Motion,
    known: Option<&Arc<RobotModel>>,
    method: Method,
    request: &[u64],
    lent: &[Foreign],
) -> Result<Vec<u64>, PluginError> {
    let Method::Plan = method else { return Err(not_answered(method)) };
    let Task { robot: sent, start, holding, carried, key_poses, obstacles } =
        Reader::whole(request)?;
    let [kinematics] = lent else { return Err(missing()) };
    let robot = robot(sent, known)?;
    let kinematics = Remote::new(*kinematics, Some(Arc::clone(&robot)));
    let task = MotionTask {
        start: &start,
        holding,
        carried: &carried,
        key_poses: &key_poses,
        obstacles: &obstacles,
    };
    Ok(message(&[&plugin.plan(&robot, &kinematics, &task)?]))
}
