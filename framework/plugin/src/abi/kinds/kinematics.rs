//! Messages of kind `kinematics`, also where kinematics are lent.

use super::clearance::ClearanceCallee;
use super::{Remote, robot};
use crate::abi::callee::{Callee, lend, missing, not_answered};
use crate::abi::cells::{Put, Reader, Take, fields, message};
use crate::abi::methods::Method;
use crate::{Clearance, IkOutcome, IkQuery, IkStatus, Kinematics, PluginError};
use seeone_core::Pose;
use seeone_core::robot::RobotModel;
use std::sync::Arc;

/// A query that has crossed, without its clearance, which is lent.
struct Query {
    robot: Option<RobotModel>,
    target: Pose,
    near: Vec<f64>,
    continuous: bool,
    period_s: Option<f64>,
}

fields!(Query { robot, target, near, continuous, period_s });
fields!(IkOutcome {
    status,
    joints,
    position_error_m,
    rotation_error_rad,
    iterations,
    contact,
    reason,
});

impl Put for IkStatus {
    fn put(&self, to: &mut Vec<u64>) {
        (*self == IkStatus::Solved).put(to);
    }
}

impl Take for IkStatus {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        Ok(if bool::take(from)? { IkStatus::Solved } else { IkStatus::Infeasible })
    }
}

impl<C: Callee> Kinematics for Remote<C> {
    fn solve(&self, robot: &RobotModel, query: &IkQuery) -> Result<IkOutcome, PluginError> {
        let IkQuery { target, near, continuous, period_s, clearance } = *query;
        let sent = self.unknown(robot);
        let request = message(&[&sent, target, &near, &continuous, &period_s]);
        let clearance = clearance.map(ClearanceCallee);
        let lent = lend(&clearance);
        let sound = |outcome: &IkOutcome| outcome.check(robot);
        self.ask(Method::Solve, &request, &lent, sound)
    }
}

/// Answers with `plugin`, which knows the robot of its setup.
pub(in crate::abi) fn served(
    plugin: &dyn Kinematics,
    known: Option<&Arc<RobotModel>>,
    method: Method,
    request: &[u64],
    lent: &[&dyn Callee],
) -> Result<Vec<u64>, PluginError> {
    let Method::Solve = method else { return Err(not_answered(method)) };
    let query: Query = Reader::whole(request)?;
    let clearance = match lent {
        [] => None,
        [one] => Some(Remote::new(*one, None)),
        _ => return Err(missing()),
    };
    let outcome = plugin.solve(
        robot(query.robot, known)?.as_ref(),
        &IkQuery {
            target: &query.target,
            near: &query.near,
            continuous: query.continuous,
            period_s: query.period_s,
            clearance: clearance.as_ref().map(|one| one as &dyn Clearance),
        },
    )?;
    Ok(message(&[&outcome]))
}
