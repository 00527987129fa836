//! Cross-entropy over bins of continuous coordinates (method: Eq. 1).

use super::exponential::{exp_nonpositive, softmax_inline};
use super::{cpu_slice, grad_vec, matrix_shape};
use candle_core::{CpuStorage, CustomOp1, Layout, Result, Shape, Tensor, bail};
use seeone_core::vectorize::vectorize;
use std::sync::{Mutex, PoisonError};

/// Bins of one coordinate over `[0, 1]`.
pub const BINS: usize = 64;

/// Bins on either side of the true one beyond which a soft target is zero.
const REACH: usize = 6;

/// What the logits of each row should say.
#[derive(Clone, Debug, PartialEq)]
pub struct BinTargets {
    /// True coordinates in `[0, 1]`, a row's coordinates one after the other; values
    /// outside are taken as the nearest end.
    pub values: Vec<f32>,
    /// A weight for each row.
    pub weights: Vec<f32>,
    /// Standard deviation of the target distribution in bins; 0 puts all on the true bin.
    pub softness: f32,
}

struct CrossEntropy {
    targets: BinTargets,
    /// Gradient of the loss with respect to the logits, known since the forward pass.
    gradient: Mutex<Vec<f32>>,
}

/// The target distribution of one coordinate and the bins it covers.
fn target(value: f32, softness: f32) -> ([f32; 2 * REACH + 1], std::ops::Range<usize>) {
    let place = value.clamp(0.0, 1.0) * BINS as f32;
    let centre = (place as usize).min(BINS - 1);
    let range = centre.saturating_sub(REACH)..(centre + REACH + 1).min(BINS);
    let mut shares = [0.0; 2 * REACH + 1];
    if softness <= 0.0 {
        shares[centre - range.start] = 1.0;
        return (shares, range);
    }
    for (share, bin) in shares.iter_mut().zip(range.clone()) {
        let distance = (bin as f32 + 0.5 - place) / softness;
        *share = exp_nonpositive(-0.5 * distance * distance);
    }
    let total: f32 = shares[..range.len()].iter().sum();
    shares.iter_mut().for_each(|share| *share /= total);
    (shares, range)
}

impl CustomOp1 for CrossEntropy {
    fn name(&self) -> &'static str {
        "cross_entropy"
    }

    fn cpu_fwd(&self, logits: &CpuStorage, layout: &Layout) -> Result<(CpuStorage, Shape)> {
        let (rows, columns) = matrix_shape(layout)?;
        let BinTargets { values, weights, softness } = &self.targets;
        let axes = columns / BINS;
        if axes == 0
            || !columns.is_multiple_of(BINS)
            || values.len() != rows * axes
            || weights.len() != rows
        {
            bail!("cross entropy: {rows} x {columns} logits, {} values", values.len());
        }
        let total: f32 = weights.iter().sum();
        if !(total > 0.0 && total.is_finite()) {
            bail!("cross entropy: the weights sum to {total}");
        }
        let mut gradient = cpu_slice(logits, layout)?.to_vec();
        let mut loss = 0.0f64;
        vectorize(
            #[inline(always)]
            || {
                for (i, bins) in gradient.chunks_exact_mut(BINS).enumerate() {
                    let (shares, range) = target(values[i], *softness);
                    let expected: f32 =
                        shares.iter().zip(&bins[range.clone()]).map(|(s, l)| s * l).sum();
                    let normaliser = softmax_inline(bins);
                    let weight = weights[i / axes] / (total * axes as f32);
                    loss += f64::from(weight * (normaliser - expected));
                    for (p, share) in bins[range].iter_mut().zip(&shares) {
                        *p -= share;
                    }
                    for p in bins.iter_mut() {
                        *p *= weight;
                    }
                }
            },
        );
        *self.gradient.lock().unwrap_or_else(PoisonError::into_inner) = gradient;
        Ok((CpuStorage::F32(vec![loss as f32]), Shape::from(())))
    }

    fn bwd(&self, logits: &Tensor, _loss: &Tensor, gradient: &Tensor) -> Result<Option<Tensor>> {
        let factor = grad_vec(gradient)?[0];
        let known = self.gradient.lock().unwrap_or_else(PoisonError::into_inner);
        let scaled: Vec<f32> = known.iter().map(|v| v * factor).collect();
        Ok(Some(Tensor::from_vec(scaled, logits.dims(), logits.device())?))
    }
}

/// Weighted mean over rows and coordinates of the cross-entropy between the softmax of
/// `logits` (rows x `axes * BINS`) and the targets; a scalar, in nats.
///
/// # Errors
/// When the sizes do not agree or no weight is positive.
pub fn cross_entropy(logits: &Tensor, targets: BinTargets) -> Result<Tensor> {
    logits.apply_op1(CrossEntropy { targets, gradient: Mutex::new(Vec::new()) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ops::gradient_check::{check, variable};

    #[test]
    fn gradients_agree_with_finite_differences() {
        let logits = variable(1, &[3, 2 * BINS]);
        for softness in [0.0, 1.5] {
            let targets = BinTargets {
                values: vec![0.0, 0.31, 0.5, 1.0, 0.77, 0.02],
                weights: vec![1.0, 0.5, 2.0],
                softness,
            };
            check(&[&logits], || cross_entropy(&logits, targets.clone()));
        }
    }

    #[test]
    fn knows_nothing_and_everything() {
        let flat = Tensor::zeros((1, BINS), candle_core::DType::F32, &candle_core::Device::Cpu);
        let hard = BinTargets { values: vec![0.999], weights: vec![1.0], softness: 0.0 };
        let loss = |l: &Tensor| cross_entropy(l, hard.clone()).and_then(|l| l.to_scalar::<f32>());
        let flat = flat.expect("zeros");
        assert!((loss(&flat).expect("loss") - (BINS as f32).ln()).abs() < 1e-5);
        let sure: Vec<f32> = (0..BINS).map(|b| if b == BINS - 1 { 50.0 } else { 0.0 }).collect();
        let sure = Tensor::from_vec(sure, (1, BINS), flat.device()).expect("logits");
        assert!(loss(&sure).expect("loss") < 1e-5);
    }
}
