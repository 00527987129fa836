//! The messages of each kind: what a plugin is asked ([`Remote`]), and how it answers
//! ([`served`]).

mod alignment;
mod camera;
mod clearance;
mod encoding;
mod kinematics;
mod motion;
mod perception;
mod robot;
mod setup;
mod transfer;
mod world;

use super::callee::Callee;
use super::cells::{Reader, Take};
use super::methods::Method;
use crate::PluginError;
use seeone_core::robot::RobotModel;
use std::fmt;
use std::sync::Arc;

pub(super) use setup::{SetupMessage, setup_message};
pub(super) use world::WorldCallee;

/// How a plugin or a thing that is lent answers messages.
pub(super) mod served {
    pub(in crate::abi) use super::alignment::served as alignment;
    pub(in crate::abi) use super::camera::served as camera;
    pub(in crate::abi) use super::encoding::Fields as Encoding;
    pub(in crate::abi) use super::kinematics::served as kinematics;
    pub(in crate::abi) use super::motion::served as motion;
    pub(in crate::abi) use super::perception::served as perception;
    pub(in crate::abi) use super::robot::served as robot;
    pub(in crate::abi) use super::transfer::served as transfer;
}

/// Something on the other side of the border, with the trait of what it is; asked by another, it
/// says so. What it answers is checked before it is believed.
pub struct Remote<C> {
    callee: C,
    /// The robot that the other side knows already.
    robot: Option<Arc<RobotModel>>,
}

impl<C> fmt::Debug for Remote<C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Remote").finish_non_exhaustive()
    }
}

impl<C: Callee> Remote<C> {
    /// What answers, and the robot that it knows already.
    pub(in crate::abi) fn new(callee: C, robot: Option<Arc<RobotModel>>) -> Self {
        Self { callee, robot }
    }

    /// Asks, and takes the answer once `check` finds nothing wrong with it.
    fn ask<T: Take>(
        &self,
        method: Method,
        request: &[u64],
        lent: &[&dyn Callee],
        check: impl FnOnce(&T) -> Result<(), String>,
    ) -> Result<T, PluginError> {
        let answered = self.callee.call(method, request, lent).and_then(|cells| {
            let answer = Reader::whole(&cells)?;
            check(&answer).map_err(|cause| {
                PluginError::Internal(format!("its answer is not to be believed: {cause}"))
            })?;
            Ok(answer)
        });
        answered.map_err(|error| self.callee.blame(method, error))
    }

    /// The robot to send along: none when the other side knows it.
    fn unknown<'a>(&self, robot: &'a RobotModel) -> Option<&'a RobotModel> {
        (self.robot.as_deref() != Some(robot)).then_some(robot)
    }

    /// The robot, shared: the known one where it is that.
    fn shared(&self, robot: &RobotModel) -> Arc<RobotModel> {
        let known = self.robot.as_ref().filter(|known| known.as_ref() == robot);
        known.cloned().unwrap_or_else(|| Arc::new(robot.clone()))
    }
}

/// Whatever is answered will do.
fn anything<T>(_: &T) -> Result<(), String> {
    Ok(())
}

/// The robot of a message, else the one of the setup.
fn robot(
    sent: Option<RobotModel>,
    known: Option<&Arc<RobotModel>>,
) -> Result<Arc<RobotModel>, PluginError> {
    let none = || PluginError::Internal("no robot was sent, and none is known".into());
    sent.map(Arc::new).or_else(|| known.cloned()).ok_or_else(none)
}
