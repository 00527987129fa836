//! Messages of kind `robot`, and of the watcher that is lent to it.

use super::{Remote, anything};
use crate::abi::callee::{Callee, Foreign, missing, not_answered};
use crate::abi::cells::{Put, Reader, Take, fields, malformed, message};
use crate::abi::methods::Method;
use crate::{
    Action, Felt, GripperCommand, JointTrajectory, PluginError, Robot, RobotSample, RobotState,
    Watch,
};
use std::sync::{Mutex, PoisonError};

fields!(RobotState { joints, opening_m });
fields!(RobotSample { time_s, state });
fields!(Felt { opening_m, holding, contact });
fields!(JointTrajectory { period_s, positions });

/// 0 and a force, or 1 and an opening.
impl Put for GripperCommand {
    fn put(&self, to: &mut Vec<u64>) {
        match *self {
            GripperCommand::Close { force_n } => (0u64, force_n).put(to),
            GripperCommand::Open { opening_m } => (1u64, opening_m).put(to),
        }
    }
}

impl Take for GripperCommand {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        match <(u64, f64)>::take(from)? {
            (0, force_n) => Ok(GripperCommand::Close { force_n }),
            (1, opening_m) => Ok(GripperCommand::Open { opening_m }),
            (other, _) => Err(malformed(format!("there is no command {other} to the gripper"))),
        }
    }
}

/// 0 and a trajectory, 1 and a trajectory with a force, or 2 and a command to the gripper.
impl Put for Action {
    fn put(&self, to: &mut Vec<u64>) {
        match self {
            Action::Move(trajectory) => {
                0u64.put(to);
                trajectory.put(to);
            }
            Action::MoveUntilContact { trajectory, force_n } => {
                1u64.put(to);
                trajectory.put(to);
                force_n.put(to);
            }
            Action::Grip(command) => {
                2u64.put(to);
                command.put(to);
            }
        }
    }
}

impl Take for Action {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        match u64::take(from)? {
            0 => Ok(Action::Move(Take::take(from)?)),
            1 => {
                let (trajectory, force_n) = Take::take(from)?;
                Ok(Action::MoveUntilContact { trajectory, force_n })
            }
            2 => Ok(Action::Grip(Take::take(from)?)),
            other => Err(malformed(format!("there is no action {other}"))),
        }
    }
}

impl<C: Callee> Robot for Remote<C> {
    fn state(&mut self) -> Result<RobotState, PluginError> {
        let joints = self.joints();
        self.ask(Method::State, &[], &[], |state: &RobotState| state.check(joints))
    }

    fn execute(&mut self, action: &Action, watch: &mut Watch) -> Result<Felt, PluginError> {
        let watcher = WatchCallee { watch: Mutex::new(watch), joints: self.joints() };
        self.ask(Method::Execute, &message(&[action]), &[&watcher], Felt::check)
    }

    fn stop(&mut self) -> Result<(), PluginError> {
        self.ask(Method::Stop, &[], &[], anything)
    }
}

impl<C: Callee> Remote<C> {
    /// How many joints the robot has, where it is known.
    fn joints(&self) -> Option<usize> {
        self.robot.as_ref().map(|robot| robot.joints().len())
    }
}

/// A watcher that is lent.
struct WatchCallee<'a> {
    watch: Mutex<&'a mut Watch<'a>>,
    joints: Option<usize>,
}

impl Callee for WatchCallee<'_> {
    fn call(
        &self,
        method: Method,
        request: &[u64],
        _: &[&dyn Callee],
    ) -> Result<Vec<u64>, PluginError> {
        let Method::Watch = method else { return Err(not_answered(method)) };
        let sample: RobotSample = Reader::whole(request)?;
        sample.check(self.joints).map_err(malformed)?;
        (self.watch.lock().unwrap_or_else(PoisonError::into_inner))(&sample)?;
        Ok(Vec::new())
    }
}

/// Answers with `plugin`.
pub(in crate::abi) fn served(
    plugin: &mut dyn Robot,
    method: Method,
    request: &[u64],
    lent: &[Foreign],
) -> Result<Vec<u64>, PluginError> {
    match method {
        Method::State => {
            let () = Reader::whole(request)?;
            Ok(message(&[&plugin.state()?]))
        }
        Method::Execute => {
            let action = Reader::whole(request)?;
            let [watcher] = lent else { return Err(missing()) };
            let watcher = Remote::new(*watcher, None);
            let felt = plugin.execute(&action, &mut |sample| {
                watcher.ask(Method::Watch, &message(&[sample]), &[], anything)
            })?;
            Ok(message(&[&felt]))
        }
        Method::Stop => {
            let () = Reader::whole(request)?;
            plugin.stop()?;
            Ok(Vec::new())
        }
        other => Err(not_answered(other)),
    }
}
