//! Iteratively reweighted least squares with the Geman-McClure kernel.

use crate::closed_form::{Fit, fit};
use nalgebra::Point3;
use seeone_plugin::{AlignmentOutcome, Correspondences, PluginError};
use serde::Deserialize;

/// Median length of a standard normal three-vector: what turns a median residual into a
/// standard deviation per axis, as 1.4826 does in one dimension.
const MEDIAN_LENGTH: f64 = 1.5382;

/// Residual in standard deviations per axis below which a pair counts as kept: the 99 %
/// quantile of a standard normal three-vector's length.
const KEPT: f64 = 3.368;

/// Residuals below this share of the target's size are rounding, not noise.
const ROUNDING: f64 = 1e-12;

/// How a first fit is made robust.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Reweighting {
    /// Number of reweighted fits at most; zero leaves the first fit as it is.
    pub reweightings: usize,
    /// Residual, in standard deviations per axis, at which a pair's weight is down to a
    /// quarter. Three keeps 87 % of the efficiency of plain least squares on
    /// normal noise.
    pub tuning: f64,
}

impl Default for Reweighting {
    fn default() -> Self {
        Self { reweightings: 50, tuning: 3.0 }
    }
}

impl Reweighting {
    /// The same, once its numbers are known to make sense.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for a tuning that is not a positive number.
    pub fn checked(self) -> Result<Self, PluginError> {
        if self.tuning.is_finite() && self.tuning > 0.0 {
            Ok(self)
        } else {
            let told = format!("tuning is {}, not a positive number", self.tuning);
            Err(PluginError::Configuration(told))
        }
    }

    /// Refines `first` until it rests. The noise is estimated from the median residual at
    /// each round, and is at most `widest` (units of the target), for a first fit that is
    /// trusted to be nearer than that.
    pub(crate) fn refine(
        &self,
        pairs: &Correspondences,
        first: Fit,
        widest: f64,
    ) -> Result<AlignmentOutcome, PluginError> {
        let smallest = ROUNDING * size(pairs.target);
        let noise = |residuals: &[f64]| {
            (weighted_median(residuals, pairs.weights) / MEDIAN_LENGTH).min(widest).max(smallest)
        };
        let mut current = first;
        let mut residuals = lengths(pairs, &current);
        for _ in 0..self.reweightings {
            let reach = self.tuning * noise(&residuals);
            let weights: Vec<f64> = residuals
                .iter()
                .zip(pairs.weights)
                .map(|(r, w)| w * geman_mcclure(r / reach))
                .collect();
            current = fit(pairs, &weights).ok_or_else(on_a_line)?;
            let before = std::mem::replace(&mut residuals, lengths(pairs, &current));
            let change = before.iter().zip(&residuals).map(|(a, b)| (a - b).abs());
            if change.fold(0.0, f64::max) < smallest {
                break;
            }
        }
        Ok(outcome(pairs, &current, &residuals, KEPT * noise(&residuals)))
    }
}

/// Why a fit is refused whose rotation is not determined.
pub(crate) fn on_a_line() -> PluginError {
    PluginError::Input("the points lie on one line, so that no rotation can be told".into())
}

/// The length of each pair's residual, in units of the target.
pub(crate) fn lengths(pairs: &Correspondences, fit: &Fit) -> Vec<f64> {
    pairs.source.iter().zip(pairs.target).map(|(p, q)| (fit.transform * p - q).norm()).collect()
}

fn outcome(pairs: &Correspondences, fit: &Fit, residuals: &[f64], reach: f64) -> AlignmentOutcome {
    let (mut kept, mut squares) = (0.0, 0.0);
    for (r, w) in residuals.iter().zip(pairs.weights).filter(|(r, _)| **r <= reach) {
        kept += w;
        squares += w * r * r;
    }
    let total: f64 = pairs.weights.iter().sum();
    AlignmentOutcome {
        transform: fit.transform,
        // At least half of the weight is kept unless the noise was capped.
        residual: if kept > 0.0 { (squares / kept).sqrt() } else { 0.0 },
        inlier_share: (kept / total).min(1.0),
        condition: fit.condition,
    }
}

/// Weight of the Geman-McClure kernel at `x` reaches.
fn geman_mcclure(x: f64) -> f64 {
    1.0 / ((1.0 + x * x) * (1.0 + x * x))
}

/// The largest distance of a point from the first one.
fn size(points: &[Point3<f64>]) -> f64 {
    points.iter().map(|p| (p - points[0]).norm()).fold(f64::MIN_POSITIVE, f64::max)
}

/// The smallest value up to which half of the weight lies.
pub(crate) fn weighted_median(values: &[f64], weights: &[f64]) -> f64 {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let half = 0.5 * weights.iter().sum::<f64>();
    let mut below = 0.0;
    for &i in &order {
        below += weights[i];
        if below >= half {
            return values[i];
        }
    }
    order.last().map_or(0.0, |i| values[*i])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_follows_the_weights() {
        let values = [3.0, 1.0, 2.0];
        assert_eq!(weighted_median(&values, &[1.0, 1.0, 1.0]), 2.0);
        assert_eq!(weighted_median(&values, &[5.0, 1.0, 1.0]), 3.0);
    }

    #[test]
    fn a_pair_at_the_reach_weighs_a_quarter() {
        assert_eq!(geman_mcclure(0.0), 1.0);
        assert_eq!(geman_mcclure(1.0), 0.25);
    }
}
