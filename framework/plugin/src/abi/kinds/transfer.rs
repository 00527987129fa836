//! Messages of kind `transfer`.

use super::Remote;
use super::encoding::{FieldCallee, RemoteField};
use crate::abi::callee::{Callee, Foreign, missing, not_answered};
use crate::abi::cells::{Reader, fields, message};
use crate::abi::methods::Method;
use crate::transfer::check_candidates;
use crate::{Candidate, CanonicalCloud, PluginError, Transfer, TransferTask};
use nalgebra::Point3;
use seeone_core::Pose;

/// A task that has crossed, without its fields, which are lent.
struct Task {
    demonstrated: Pose,
    demonstrated_scale: f64,
    cloud: CanonicalCloud,
    instance_scale: f64,
    gripper_points: Vec<Point3<f64>>,
}

fields!(Task { demonstrated, demonstrated_scale, cloud, instance_scale, gripper_points });
fields!(Candidate { pose, loss, confidence, lay_on_surface, origin });

impl<C: Callee> Transfer for Remote<C> {
    fn transfer(&self, task: &TransferTask) -> Result<Vec<Candidate>, PluginError> {
        let request = message(&[
            task.demonstrated,
            &task.demonstrated_scale,
            task.cloud,
            &task.instance_scale,
            &task.gripper_points,
        ]);
        let fields = [task.demonstration, task.instance].map(FieldCallee);
        let lent: [&dyn Callee; 2] = [&fields[0], &fields[1]];
        let sound = |candidates: &Vec<Candidate>| check_candidates(candidates);
        self.ask(Method::Transfer, &request, &lent, sound)
    }
}

/// Answers with `plugin`.
pub(in crate::abi) fn served(
    plugin: &dyn Transfer,
    method: Method,
    request: &[u64],
    lent: &[Foreign],
) -> Result<Vec<u64>, PluginError> {
    let Method::Transfer = method else { return Err(not_answered(method)) };
    let task: Task = Reader::whole(request)?;
    let [demonstration, instance] = lent else { return Err(missing()) };
    let found = plugin.transfer(&TransferTask {
        demonstrated: &task.demonstrated,
        demonstrated_scale: task.demonstrated_scale,
        demonstration: &RemoteField::lent(*demonstration),
        instance: &RemoteField::lent(*instance),
        cloud: &task.cloud,
        instance_scale: task.instance_scale,
        gripper_points: &task.gripper_points,
    })?;
    Ok(message(&[&found]))
}
