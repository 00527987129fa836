//! Training: data-parallel, reproducible to the bit, resumable.
//!
//! A batch is split into two fixed shards, each computed on a thread of its own, and their
//! gradients are summed in a fixed order; a sample is a function of its number. So the
//! result depends on the plan alone, not on scheduling, and a resumed training continues
//! exactly where it was interrupted.

use crate::Parameters;
use crate::checkpoint::{self, CheckpointError};
use crate::curve::Curve;
use crate::optimizer::AdamW;
use crate::schedule::rate_factor;
use candle_core::Tensor;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::ops::{ControlFlow, Range};
use std::path::Path;

/// Shards of a batch; fixed, because their number changes the sums' rounding.
const SHARDS: u64 = 2;
/// Samples between two reports of progress.
const REPORT_EVERY: u64 = 128;

/// What to do with how many samples.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// What is trained, on what, from which seed: two trainings whose checkpoints must not
    /// be mixed up differ in it.
    pub label: String,
    /// Samples in all, rounded up to whole batches.
    pub samples: u64,
    /// Samples a step; even.
    pub batch: u64,
    /// Learning rate of the flat part of the schedule.
    pub peak_rate: f64,
    /// Samples between two checkpoints.
    pub checkpoint_every: u64,
}

/// How far a training is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Samples seen.
    pub done: u64,
    /// Samples in all.
    pub total: u64,
    /// Mean loss since the last report.
    pub loss: f64,
}

/// How a training ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ending {
    /// All samples were seen.
    Finished,
    /// The caller broke off; a checkpoint was written if there is a place for one.
    Interrupted,
}

/// Why a training could not go on.
#[derive(Debug, thiserror::Error)]
pub enum TrainError {
    /// The plan makes no sense.
    #[error("training plan: {0}")]
    Plan(String),
    /// The loss or its gradient is not finite.
    #[error("the loss is {loss} and its gradient {gradient} long after {done} samples")]
    Diverged {
        /// The loss of the batch.
        loss: f64,
        /// Length of its gradient.
        gradient: f64,
        /// Samples seen before.
        done: u64,
    },
    /// The checkpoint could not be read or written.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// A tensor operation failed.
    #[error("network: {0}")]
    Network(#[from] candle_core::Error),
}

impl Plan {
    fn check(&self) -> Result<(), TrainError> {
        let wrong = |what: &str| Err(TrainError::Plan(what.into()));
        if self.batch == 0 || !self.batch.is_multiple_of(SHARDS) {
            return wrong("the batch must be even and not empty");
        }
        if self.samples == 0 || self.checkpoint_every == 0 {
            return wrong("numbers of samples must be positive");
        }
        if !(self.peak_rate > 0.0 && self.peak_rate.is_finite()) {
            return wrong("the learning rate must be positive");
        }
        Ok(())
    }

    /// Samples in whole batches.
    pub fn total(&self) -> u64 {
        self.samples.div_ceil(self.batch) * self.batch
    }
}

/// One shard's loss and gradient.
type ShardResult = candle_core::Result<(f64, Vec<f32>)>;

/// Trains `parameters` until the plan is fulfilled or `progress` breaks off.
///
/// `loss` gives the mean loss of the samples with the given numbers. With a `checkpoint`
/// path the training resumes from the file when it is there, and leaves it behind, with the
/// learning curve beside it (`*.curve.csv` and `*.curve.svg`).
///
/// # Errors
/// [`TrainError`]; a training that diverged leaves its last checkpoint as it was.
pub fn train(
    parameters: &Parameters,
    plan: &Plan,
    checkpoint: Option<&Path>,
    loss: &(dyn Fn(Range<u64>) -> candle_core::Result<Tensor> + Sync),
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<Ending, TrainError> {
    plan.check()?;
    let pools = pools()?;
    let fingerprint = checkpoint::fingerprint(parameters, plan);
    let (mut values, mut adam, mut done) =
        (parameters.values()?, AdamW::new(parameters.count()), 0);
    if let Some(path) = checkpoint.filter(|path| path.exists()) {
        (values, adam, done) = checkpoint::read(path, &fingerprint, values.len())?;
        parameters.set_values(&values)?;
    }
    let mut curve = Curve::resume(checkpoint, done);
    let save = |values: &[f32], adam: &AdamW, done, curve: &Curve| match checkpoint {
        Some(path) => {
            curve.save().map_err(|e| CheckpointError::File(path.into(), e))?;
            checkpoint::write(path, &fingerprint, values, adam, done)
        }
        None => Ok(()),
    };
    let total = plan.total();
    let (mut sum, mut batches) = (0.0, 0u32);
    while done < total {
        let (batch_loss, gradient) = gradient(parameters, &pools, done..done + plan.batch, loss)?;
        let rate = plan.peak_rate * rate_factor(done as f64 / total as f64);
        let length = adam.step(&mut values, &gradient, rate);
        if !(batch_loss.is_finite() && length.is_finite()) {
            return Err(TrainError::Diverged { loss: batch_loss, gradient: length, done });
        }
        parameters.set_values(&values)?;
        let before = done;
        done += plan.batch;
        (sum, batches) = (sum + batch_loss, batches + 1);
        let passed = |every: u64| done / every != before / every || done == total;
        let report = passed(REPORT_EVERY).then(|| {
            let report = Progress { done, total, loss: sum / f64::from(batches) };
            (sum, batches) = (0.0, 0);
            curve.push(done, report.loss);
            report
        });
        if passed(plan.checkpoint_every) {
            save(&values, &adam, done, &curve)?;
        }
        if report.is_some_and(|report| progress(report).is_break()) && done < total {
            save(&values, &adam, done, &curve)?;
            return Ok(Ending::Interrupted);
        }
    }
    Ok(Ending::Finished)
}

/// One thread each, so that an operation that asks for threads finds one and stays on it.
fn pools() -> Result<[ThreadPool; SHARDS as usize], TrainError> {
    let pool = || ThreadPoolBuilder::new().num_threads(1).build();
    match (pool(), pool()) {
        (Ok(a), Ok(b)) => Ok([a, b]),
        (Err(e), _) | (_, Err(e)) => Err(TrainError::Plan(format!("no threads: {e}"))),
    }
}

/// Mean loss and gradient of a batch.
fn gradient(
    parameters: &Parameters,
    pools: &[ThreadPool; SHARDS as usize],
    batch: Range<u64>,
    loss: &(dyn Fn(Range<u64>) -> candle_core::Result<Tensor> + Sync),
) -> Result<(f64, Vec<f32>), TrainError> {
    let middle = batch.start + (batch.end - batch.start) / SHARDS;
    let shard = |pool: &ThreadPool, samples: Range<u64>| -> ShardResult {
        pool.install(|| {
            let loss = loss(samples)?;
            let gradient = parameters.gradients(&loss.backward()?)?;
            Ok((f64::from(loss.to_scalar::<f32>()?), gradient))
        })
    };
    let (left, right) = std::thread::scope(|scope| {
        let left = scope.spawn(|| shard(&pools[0], batch.start..middle));
        let right = shard(&pools[1], middle..batch.end);
        (left.join(), right)
    });
    let (loss_left, mut sum) = match left {
        Ok(result) => result?,
        Err(panic) => std::panic::resume_unwind(panic),
    };
    let (loss_right, gradient_right) = right?;
    for (a, b) in sum.iter_mut().zip(&gradient_right) {
        *a = 0.5 * (*a + b);
    }
    Ok((0.5 * (loss_left + loss_right), sum))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layers::Linear;
    use crate::ops::Activation;
    use candle_core::Device;
    use seeone_core::random::{generator, normal};

    fn plan() -> Plan {
        Plan {
            label: "line".into(),
            samples: 1500,
            batch: 4,
            peak_rate: 0.05,
            checkpoint_every: 512,
        }
    }

    /// Fits `y = 2 a - b + 0.5`; returns the loss at the end and all values.
    fn fit(checkpoint: Option<&Path>, stop_after: u64) -> (Ending, f64, Vec<f32>) {
        let mut parameters = Parameters::new(3);
        let layer =
            Linear::new(&mut parameters, "line", 2, 1, Activation::Identity).expect("a layer");
        let loss = |samples: Range<u64>| {
            let rows: Vec<[f32; 3]> = samples
                .map(|n| {
                    let mut rng = generator(n, "line");
                    let (a, b) = (normal(&mut rng) as f32, normal(&mut rng) as f32);
                    [a, b, 2.0 * a - b + 0.5]
                })
                .collect();
            let column = |i: usize| rows.iter().map(|r| r[i]).collect::<Vec<f32>>();
            let x: Vec<f32> = rows.iter().flat_map(|r| [r[0], r[1]]).collect();
            let x = Tensor::from_vec(x, (rows.len(), 2), &Device::Cpu)?;
            let y = Tensor::from_vec(column(2), (rows.len(), 1), &Device::Cpu)?;
            (layer.forward(&x)? - y)?.sqr()?.mean_all()
        };
        let mut last = f64::NAN;
        let mut progress = |p: Progress| {
            last = p.loss;
            if p.done >= stop_after { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let ending =
            train(&parameters, &plan(), checkpoint, &loss, &mut progress).expect("trained");
        (ending, last, parameters.values().expect("values"))
    }

    #[test]
    fn learns_and_is_reproducible_to_the_bit() {
        let (ending, loss, values) = fit(None, u64::MAX);
        assert_eq!(ending, Ending::Finished);
        assert!(loss < 1e-3, "loss {loss}");
        assert_eq!(values, fit(None, u64::MAX).2);
    }

    #[test]
    fn a_resumed_training_ends_like_an_uninterrupted_one() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("line.checkpoint");
        assert_eq!(fit(Some(&path), 700).0, Ending::Interrupted);
        let (ending, _, values) = fit(Some(&path), u64::MAX);
        assert_eq!(ending, Ending::Finished);
        let whole = folder.path().join("whole.checkpoint");
        assert_eq!(values, fit(Some(&whole), u64::MAX).2);
        let curve = |path: &Path| std::fs::read(path.with_extension("curve.csv")).expect("a curve");
        assert_eq!(curve(&path), curve(&whole));
    }

    #[test]
    fn refuses_an_odd_batch_and_reports_divergence() {
        let mut parameters = Parameters::new(3);
        let x = parameters.constant("x", 1, 1.0).expect("x");
        let bad = Plan { batch: 3, ..plan() };
        let run = |plan: &Plan, factor: f64| {
            let loss = |_: Range<u64>| (&x * factor)?.sum_all();
            train(&parameters, plan, None, &loss, &mut |_| ControlFlow::Continue(()))
        };
        assert!(matches!(run(&bad, 1.0), Err(TrainError::Plan(_))));
        assert!(matches!(run(&plan(), f64::NAN), Err(TrainError::Diverged { done: 0, .. })));
    }
}
