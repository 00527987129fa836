//! Kind `alignment`: the similarity that carries one point set onto another.

use crate::PluginError;
use nalgebra::Point3;
use seeone_core::Similarity;

/// Pairs of corresponding points with weights; the three slices have one length.
#[derive(Clone, Copy, Debug)]
pub struct Correspondences<'a> {
    /// Where the points are.
    pub source: &'a [Point3<f64>],
    /// Where they shall go.
    pub target: &'a [Point3<f64>],
    /// Non-negative weight of each pair.
    pub weights: &'a [f64],
    /// The scale to use instead of estimating one: Eq. 6 forgets that the canonical cube
    /// is normalised, so scale is taken from the whole cloud and kept for the grip patch.
    pub fixed_scale: Option<f64>,
}

impl Correspondences<'_> {
    /// Refuses what no alignment can work on, so that every implementation refuses alike.
    /// Points all on one line are for the solver to find, as its robust weights decide
    /// which points count.
    ///
    /// # Errors
    /// [`PluginError::Input`] for lengths that differ, numbers that are not finite,
    /// negative weights, fewer than three pairs that weigh anything, or a fixed scale that
    /// is not positive.
    pub fn check(&self) -> Result<(), PluginError> {
        let (n, m, k) = (self.source.len(), self.target.len(), self.weights.len());
        if n != m || n != k {
            return refuse(format!("{n} source points, {m} target points and {k} weights"));
        }
        let finite = |p: &Point3<f64>| p.coords.iter().all(|v| v.is_finite());
        if let Some(i) = (0..n).find(|i| !finite(&self.source[*i]) || !finite(&self.target[*i])) {
            return refuse(format!("pair {i} is not finite"));
        }
        if let Some(i) = self.weights.iter().position(|w| !w.is_finite() || *w < 0.0) {
            return refuse(format!(
                "weight {i} is {}, not a number from 0 upwards",
                self.weights[i]
            ));
        }
        let weighing = self.weights.iter().filter(|w| **w > 0.0).count();
        if weighing < 3 {
            return refuse(format!("{weighing} pairs weigh anything; an alignment needs 3"));
        }
        match self.fixed_scale {
            Some(scale) if !scale.is_finite() || scale <= 0.0 => {
                refuse(format!("the fixed scale is {scale}, not a positive number"))
            }
            _ => Ok(()),
        }
    }
}

fn refuse<T>(cause: String) -> Result<T, PluginError> {
    Err(PluginError::Input(cause))
}

/// What an alignment found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AlignmentOutcome {
    /// Source -> target.
    pub transform: Similarity,
    /// Root mean square residual over the inliers, in units of the target.
    pub residual: f64,
    /// Share of the total weight that the robust fit kept.
    pub inlier_share: f64,
    /// Smallest over largest singular value that determines the rotation, in `[0, 1]`:
    /// near zero for collinear points, whose rotation is not determined.
    pub condition: f64,
}

impl AlignmentOutcome {
    /// Says what no alignment may answer.
    ///
    /// # Errors
    /// A sentence about a number that is not finite or out of its range.
    pub fn check(&self) -> Result<(), String> {
        let share = 0.0..=1.0;
        let sound = self.transform.to_homogeneous().iter().all(|v| v.is_finite())
            && self.residual.is_finite()
            && self.residual >= 0.0
            && share.contains(&self.inlier_share)
            && share.contains(&self.condition);
        if sound { Ok(()) } else { Err(format!("a number is out of its range: {self:?}")) }
    }
}

/// Correspondences -> similarity (method: Eq. 6, Procrustes).
pub trait Alignment: Send + Sync {
    /// Aligns the pairs.
    ///
    /// # Errors
    /// [`PluginError::Input`] for fewer than three pairs, lengths that differ, numbers
    /// that are not finite, or points all on one line.
    fn align(&self, pairs: &Correspondences) -> Result<AlignmentOutcome, PluginError>;
}
