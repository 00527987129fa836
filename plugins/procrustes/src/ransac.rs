//! Random sample consensus (Fischler and Bolles 1981; MSAC's truncated score, Torr and
//! Zisserman 2000), then reweighting.

use crate::closed_form::{Fit, fit};
use crate::reweighting::{Reweighting, lengths, on_a_line, weighted_median};
use rand::{Rng, RngExt};
use seeone_core::random::generator;
use seeone_plugin::{Alignment, AlignmentOutcome, Correspondences, PluginError, Setup};
use serde::Deserialize;

/// The table of the configuration.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Config {
    /// Fits to three pairs that are tried. 200 meet three right pairs out of 30 % right
    /// ones with a probability of 99.6 %.
    hypotheses: usize,
    /// Residual beyond which a pair speaks against no hypothesis more than any other, as a
    /// share of the target's size (median distance from its mean).
    threshold: f64,
    /// As [`Reweighting::reweightings`].
    reweightings: usize,
    /// As [`Reweighting::tuning`].
    tuning: f64,
}

impl Default for Config {
    fn default() -> Self {
        let Reweighting { reweightings, tuning } = Reweighting::default();
        Self { hypotheses: 200, threshold: 0.15, reweightings, tuning }
    }
}

/// Alignment that survives a majority of wrong pairs, as long as the right ones agree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ransac {
    hypotheses: usize,
    threshold: f64,
    reweighting: Reweighting,
    seed: u64,
}

impl Ransac {
    /// From its table of the configuration: `hypotheses`, `threshold` (share of the
    /// target's size), `reweightings` and `tuning`.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for an unknown key or a number out of range.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        let config: Config = setup.configuration()?;
        if !config.threshold.is_finite() || config.threshold <= 0.0 {
            let told = format!("threshold is {}, not a positive number", config.threshold);
            return Err(PluginError::Configuration(told));
        }
        if !(1..=100_000).contains(&config.hypotheses) {
            let told = format!("hypotheses is {}, not from 1 to 100000", config.hypotheses);
            return Err(PluginError::Configuration(told));
        }
        let Config { reweightings, tuning, .. } = config;
        Ok(Self {
            hypotheses: config.hypotheses,
            threshold: config.threshold,
            reweighting: Reweighting { reweightings, tuning }.checked()?,
            seed: setup.seed,
        })
    }

    /// The fit to three pairs with the least truncated sum of squares over all pairs.
    fn best_hypothesis(&self, pairs: &Correspondences, threshold: f64) -> Option<Fit> {
        // A generator for each call: the answer does not hang on what was asked before.
        let mut rng = generator(self.seed, "ransac");
        let weighing: Vec<usize> =
            (0..pairs.weights.len()).filter(|i| pairs.weights[*i] > 0.0).collect();
        let mut best: Option<(f64, Fit)> = None;
        for _ in 0..self.hypotheses {
            let [a, b, c] = three_of(&weighing, &mut rng);
            let sample = Correspondences {
                source: &[a, b, c].map(|i| pairs.source[i]),
                target: &[a, b, c].map(|i| pairs.target[i]),
                weights: &[1.0; 3],
                fixed_scale: pairs.fixed_scale,
            };
            let Some(hypothesis) = fit(&sample, sample.weights) else { continue };
            let score: f64 = lengths(pairs, &hypothesis)
                .iter()
                .zip(pairs.weights)
                .map(|(r, w)| w * r.min(threshold).powi(2))
                .sum();
            if best.as_ref().is_none_or(|(least, _)| score < *least) {
                best = Some((score, hypothesis));
            }
        }
        best.map(|(_, hypothesis)| hypothesis)
    }
}

impl Alignment for Ransac {
    fn align(&self, pairs: &Correspondences) -> Result<AlignmentOutcome, PluginError> {
        pairs.check()?;
        let threshold = self.threshold * size(pairs);
        let first = self.best_hypothesis(pairs, threshold).ok_or_else(on_a_line)?;
        // Where most pairs are wrong the median residual is theirs; the threshold, three
        // standard deviations wide, bounds the noise of the right ones.
        self.reweighting.refine(pairs, first, threshold / 3.0)
    }
}

/// Three different members of `indices`, which has at least three.
fn three_of(indices: &[usize], rng: &mut impl Rng) -> [usize; 3] {
    let n = indices.len();
    let mut chosen = [0; 3];
    for k in 0..3 {
        chosen[k] = rng.random_range(0..n);
        while chosen[..k].contains(&chosen[k]) {
            chosen[k] = rng.random_range(0..n);
        }
    }
    chosen.map(|i| indices[i])
}

/// Median distance of the target's points from their mean.
fn size(pairs: &Correspondences) -> f64 {
    let total: f64 = pairs.weights.iter().sum();
    let mean: nalgebra::Vector3<f64> =
        pairs.target.iter().zip(pairs.weights).map(|(p, w)| p.coords * (w / total)).sum();
    let distances: Vec<f64> = pairs.target.iter().map(|p| (p.coords - mean).norm()).collect();
    weighted_median(&distances, pairs.weights)
}
