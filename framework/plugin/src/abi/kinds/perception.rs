//! Messages of kind `perception`.

use super::Remote;
use crate::abi::callee::{Callee, not_answered};
use crate::abi::cells::{Reader, fields, message};
use crate::abi::methods::Method;
use crate::{CanonicalCloud, Observation, Perception, PluginError};

fields!(CanonicalCloud { points, nocs, confidence, features, feature_width });

impl<C: Callee> Perception for Remote<C> {
    fn perceive(&mut self, observation: &Observation) -> Result<CanonicalCloud, PluginError> {
        self.ask(Method::Perceive, &message(&[observation]), &[], CanonicalCloud::check)
    }
}

/// Answers with `plugin`.
pub(in crate::abi) fn served(
    plugin: &mut dyn Perception,
    method: Method,
    request: &[u64],
) -> Result<Vec<u64>, PluginError> {
    let Method::Perceive = method else { return Err(not_answered(method)) };
    let observation: Observation = Reader::whole(request)?;
    Ok(message(&[&plugin.perceive(&observation)?]))
}
