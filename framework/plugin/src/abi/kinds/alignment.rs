//! Messages of kind `alignment`.

use super::Remote;
use crate::abi::callee::{Callee, not_answered};
use crate::abi::cells::{Reader, fields, message};
use crate::abi::methods::Method;
use crate::{Alignment, AlignmentOutcome, Correspondences, PluginError};
use nalgebra::Point3;

/// Pairs that have crossed.
struct Pairs {
    source: Vec<Point3<f64>>,
    target: Vec<Point3<f64>>,
    weights: Vec<f64>,
    fixed_scale: Option<f64>,
}

fields!(Pairs { source, target, weights, fixed_scale });
fields!(AlignmentOutcome { transform, residual, inlier_share, condition });

impl<C: Callee> Alignment for Remote<C> {
    fn align(&self, pairs: &Correspondences) -> Result<AlignmentOutcome, PluginError> {
        let Correspondences { source, target, weights, fixed_scale } = pairs;
        let request = message(&[source, target, weights, fixed_scale]);
        self.ask(Method::Align, &request, &[], AlignmentOutcome::check)
    }
}

/// Answers with `plugin`.
pub(in crate::abi) fn served(
    plugin: &dyn Alignment,
    method: Method,
    request: &[u64],
) -> Result<Vec<u64>, PluginError> {
    let Method::Align = method else { return Err(not_answered(method)) };
    let Pairs { source, target, weights, fixed_scale } = Reader::whole(request)?;
    let pairs =
        Correspondences { source: &source, target: &target, weights: &weights, fixed_scale };
    Ok(message(&[&plugin.align(&pairs)?]))
}
