//! Messages of kind `camera`.

use super::Remote;
use crate::abi::callee::{Callee, not_answered};
use crate::abi::cells::{Put, Reader, Take, fields, malformed, message};
use crate::abi::methods::Method;
use crate::{Camera, Observation, PluginError};
use seeone_core::{Cloud, DepthImage, Intrinsics};

fields!(Intrinsics { width, height, fx, fy, cx, cy });
fields!(DepthImage { intrinsics, depth_m });
fields!(Observation { depth, cloud, camera_position });

impl Put for Cloud {
    fn put(&self, to: &mut Vec<u64>) {
        self.points().put(to);
    }
}

impl Take for Cloud {
    fn take(from: &mut Reader) -> Result<Self, PluginError> {
        Cloud::new(Take::take(from)?)
            .map_err(|index| malformed(format!("point {index} of the cloud is not finite")))
    }
}

impl<C: Callee> Camera for Remote<C> {
    fn observe(&mut self) -> Result<Observation, PluginError> {
        self.ask(Method::Observe, &[], &[], Observation::check)
    }
}

/// Answers with `plugin`.
pub(in crate::abi) fn served(
    plugin: &mut dyn Camera,
    method: Method,
    request: &[u64],
) -> Result<Vec<u64>, PluginError> {
    let Method::Observe = method else { return Err(not_answered(method)) };
    let () = Reader::whole(request)?;
    Ok(message(&[&plugin.observe()?]))
}
