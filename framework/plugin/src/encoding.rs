//! Kind `encoding`: features at any point of the canonical cube.

use crate::{CanonicalCloud, PluginError};
use nalgebra::Point3;

/// `rows x width` features, row by row, and, where asked for, their derivatives.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Features {
    /// Number of features a query point.
    pub width: usize,
    /// `rows * width` values.
    pub values: Vec<f32>,
}

impl Features {
    /// Says what no field may answer to `rows` query points.
    ///
    /// # Errors
    /// A sentence about a wrong length or a number that is not finite.
    pub fn check(&self, rows: usize) -> Result<(), String> {
        let values = self.values.len();
        if rows.checked_mul(self.width) != Some(values) {
            return Err(format!("{rows} points of {} features each have {values}", self.width));
        }
        if !self.values.iter().all(|v| v.is_finite()) {
            return Err("a feature is not finite".into());
        }
        Ok(())
    }

    /// Mean absolute difference of two feature sets of equal shape: the loss of Eq. 9.
    pub fn mean_difference(&self, other: &Self) -> f64 {
        let sum: f64 =
            self.values.iter().zip(&other.values).map(|(a, b)| f64::from((a - b).abs())).sum();
        sum / self.values.len().max(1) as f64
    }
}

/// What an encoding makes of one canonical cloud: a function on the canonical cube.
pub trait Field: Send + Sync {
    /// Features at each query point (Eq. 3); points outside the cube see its border.
    fn features(&self, queries: &[Point3<f64>]) -> Features;

    /// Generalised winding number at each query point (Eq. 4), where the encoding knows
    /// the shape.
    fn winding(&self, queries: &[Point3<f64>]) -> Option<Vec<f64>>;
}

/// Canonical cloud -> field (method: NSE, Eq. 3 to 5).
pub trait Encoding: Send {
    /// Encodes one canonical cloud.
    ///
    /// # Errors
    /// [`PluginError::Input`] when the cloud is empty or carries the features of another
    /// perception than the one that this encoding was trained on.
    fn encode(&mut self, cloud: &CanonicalCloud) -> Result<Box<dyn Field>, PluginError>;
}
