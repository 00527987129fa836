//! Kind `perception`: where does each observed point lie in the canonical state?

use crate::{Observation, PluginError};
use nalgebra::Point3;

/// Observed points with their canonical coordinates. All vectors have the same length
/// `N`, except `features`, which has `N * feature_width` numbers, row by row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CanonicalCloud {
    /// Observed points in `world`, metres (a subset of the observation).
    pub points: Vec<Point3<f64>>,
    /// Their coordinates in the canonical cube `[0, 1]^3`.
    pub nocs: Vec<Point3<f64>>,
    /// Confidence of each coordinate in `[0, 1]`.
    pub confidence: Vec<[f64; 3]>,
    /// Features of each point.
    pub features: Vec<f32>,
    /// Number of features a point.
    pub feature_width: usize,
}

impl CanonicalCloud {
    /// Says what no perception may answer.
    ///
    /// # Errors
    /// A sentence about lengths that differ, or a number that is not finite or out of its
    /// range.
    pub fn check(&self) -> Result<(), String> {
        let n = self.points.len();
        let (nocs, confidence) = (self.nocs.len(), self.confidence.len());
        if (nocs, confidence) != (n, n) {
            return Err(format!("{n} points, {nocs} canonical ones and {confidence} confidences"));
        }
        let features = self.features.len();
        if n.checked_mul(self.feature_width) != Some(features) {
            let width = self.feature_width;
            return Err(format!("{n} points of {width} features each have {features}"));
        }
        let finite = |p: &Point3<f64>| p.coords.iter().all(|v| v.is_finite());
        if let Some(i) = (0..n).find(|i| !finite(&self.points[*i]) || !finite(&self.nocs[*i])) {
            return Err(format!("point {i} is not finite"));
        }
        if !self.confidence.iter().flatten().all(|c| (0.0..=1.0).contains(c)) {
            return Err("a confidence is not between 0 and 1".into());
        }
        if !self.features.iter().all(|v| v.is_finite()) {
            return Err("a feature is not finite".into());
        }
        Ok(())
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// One number for each point: the product of its three confidences.
    pub fn weights(&self) -> impl Iterator<Item = f64> + '_ {
        self.confidence.iter().map(|c| c[0] * c[1] * c[2])
    }

    /// How sure the cloud is as a whole, in `[0, 1]`: the geometric mean of each point's
    /// three confidences, averaged over the points; zero for an empty cloud.
    pub fn mean_confidence(&self) -> f64 {
        let sum: f64 = self.weights().map(|w| w.max(0.0).cbrt().min(1.0)).sum();
        sum / self.len().max(1) as f64
    }
}

/// Observation -> canonical cloud (method: NST, Eq. 1 and 2).
pub trait Perception: Send {
    /// Perceives one observation.
    ///
    /// # Errors
    /// [`PluginError::Input`] when there are too few points to say anything.
    fn perceive(&mut self, observation: &Observation) -> Result<CanonicalCloud, PluginError>;
}
