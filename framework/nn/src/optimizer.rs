//! AdamW on flat vectors (Loshchilov and Hutter 2019).

use seeone_core::vectorize::vectorize;

/// Decay of the first moment.
const BETA_1: f32 = 0.9;
/// Decay of the second moment: .98 rather than .999, because trainings are short.
const BETA_2: f32 = 0.98;
/// Weight decay, not multiplied into the gradient.
const WEIGHT_DECAY: f32 = 0.01;
/// Longest gradient that is taken as it is; a longer one is shortened to this.
const CLIP: f32 = 1.0;
const EPSILON: f32 = 1e-8;

/// Moments of every parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct AdamW {
    /// Running means of the gradients.
    pub(crate) first: Vec<f32>,
    /// Running means of their squares.
    pub(crate) second: Vec<f32>,
    /// Steps taken.
    pub(crate) steps: u64,
}

impl AdamW {
    /// For `count` parameters, before the first step.
    pub fn new(count: usize) -> Self {
        Self { first: vec![0.0; count], second: vec![0.0; count], steps: 0 }
    }

    /// One step of length `rate` along `gradient`, which is clipped to length 1 first.
    /// Returns the gradient's length before clipping.
    pub fn step(&mut self, values: &mut [f32], gradient: &[f32], rate: f64) -> f64 {
        self.steps += 1;
        let length = gradient.iter().map(|g| f64::from(*g).powi(2)).sum::<f64>().sqrt();
        let shorten = if length > f64::from(CLIP) { CLIP / length as f32 } else { 1.0 };
        let steps = self.steps.min(10_000) as i32; // both corrections are 1 long before
        let correction_1 = 1.0 / (1.0 - BETA_1.powi(steps));
        let correction_2 = 1.0 / (1.0 - BETA_2.powi(steps));
        let rate = rate as f32;
        let Self { first, second, .. } = self;
        vectorize(
            #[inline(always)]
            || {
                let moments = first.iter_mut().zip(second.iter_mut());
                for ((value, g), (m, v)) in values.iter_mut().zip(gradient).zip(moments) {
                    let g = g * shorten;
                    *m = BETA_1 * *m + (1.0 - BETA_1) * g;
                    *v = BETA_2 * *v + (1.0 - BETA_2) * g * g;
                    let step = *m * correction_1 / ((*v * correction_2).sqrt() + EPSILON);
                    *value -= rate * (step + WEIGHT_DECAY * *value);
                }
            },
        );
        length
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walks_to_the_bottom_of_a_bowl_and_clips() {
        let (mut x, mut adam) = (vec![3.0f32, -2.0], AdamW::new(2));
        let length = adam.step(&mut x, &[300.0, 400.0], 0.0);
        assert!((length - 500.0).abs() < 1e-9);
        assert!((adam.first[0] - 0.1 * 0.6).abs() < 1e-6, "the clipped gradient enters");
        for i in 0..2000 {
            let gradient = [x[0] - 1.0, 10.0 * (x[1] - 0.5)];
            adam.step(&mut x, &gradient, 0.01 * (1.0 - f64::from(i) / 2000.0));
        }
        assert!((x[0] - 1.0).abs() < 0.02 && (x[1] - 0.5).abs() < 0.02, "{x:?}");
    }
}
