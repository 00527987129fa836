//! From the probabilities of bins to a coordinate and a confidence.

use candle_core::{Result, Tensor};
use seeone_nn::ops::{BINS, softmax_in_place};

/// Bins on either side of the winning one that take part in the expectation.
const REACH: usize = 3;

/// Coordinates and confidences of query points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Readout {
    /// Three coordinates in `[0, 1]` a point.
    pub values: Vec<[f64; 3]>,
    /// For each, the probability that lies within the bins read out.
    pub confidence: Vec<[f64; 3]>,
}

impl Readout {
    /// The mean of several answers about the same points.
    pub fn mean(answers: &[Self]) -> Self {
        let mean = |pick: fn(&Self) -> &Vec<[f64; 3]>| -> Vec<[f64; 3]> {
            let count = answers.iter().map(|a| pick(a).len()).min().unwrap_or(0);
            let at = |point: usize, axis: usize| -> f64 {
                answers.iter().map(|a| pick(a)[point][axis]).sum::<f64>() / answers.len() as f64
            };
            (0..count).map(|point| std::array::from_fn(|axis| at(point, axis))).collect()
        };
        Self { values: mean(|a| &a.values), confidence: mean(|a| &a.confidence) }
    }
}

/// Expectation over the winning bin and its neighbours: arg-max alone would cost up to half
/// a bin, the expectation over all bins would average different places.
fn read_bins(logits: &mut [f32]) -> (f64, f64) {
    softmax_in_place(logits);
    let winner = (0..BINS).fold(0, |best, i| if logits[i] > logits[best] { i } else { best });
    let range = winner.saturating_sub(REACH)..(winner + REACH + 1).min(BINS);
    let (mut mass, mut moment) = (0.0, 0.0);
    for bin in range {
        let p = f64::from(logits[bin]);
        mass += p;
        moment += p * (bin as f64 + 0.5) / BINS as f64;
    }
    (moment / mass, mass.min(1.0))
}

/// Reads out logits (rows x `3 * BINS`).
///
/// # Errors
/// When they have another shape.
pub fn read(logits: &Tensor) -> Result<Readout> {
    let mut readout = Readout::default();
    for mut row in logits.to_vec2::<f32>()? {
        let (mut values, mut confidence) = ([0.0; 3], [0.0; 3]);
        for (axis, bins) in row.chunks_exact_mut(BINS).take(3).enumerate() {
            (values[axis], confidence[axis]) = read_bins(bins);
        }
        readout.values.push(values);
        readout.confidence.push(confidence);
    }
    Ok(readout)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_between_bins_and_ignores_a_far_second_peak() {
        let mut logits: Vec<f32> = (0..BINS)
            .map(|b| {
                let near = -0.5 * ((b as f32 + 0.5 - 20.3) / 1.5).powi(2);
                let far = -0.5 * ((b as f32 + 0.5 - 50.0) / 1.5).powi(2) - 0.7;
                (near.exp() + far.exp()).max(1e-9).ln()
            })
            .collect();
        let (value, confidence) = read_bins(&mut logits);
        assert!((value * BINS as f64 - 20.3).abs() < 0.1, "{}", value * BINS as f64);
        assert!((0.55..0.75).contains(&confidence), "{confidence}");
    }
}
