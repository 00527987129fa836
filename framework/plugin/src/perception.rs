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
