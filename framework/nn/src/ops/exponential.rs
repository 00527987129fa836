//! An exponential that vectorises, and sums that do.

use seeone_core::vectorize::vectorize;

/// `e^x` for `x <= 0` to about one part in 10^7; zero-like below -87.
#[inline(always)]
pub(crate) fn exp_nonpositive(x: f32) -> f32 {
    let x = x.max(-87.0);
    let n = (x * std::f32::consts::LOG2_E + 0.5).floor();
    // ln 2 in two parts, so that the reduced argument keeps its digits (Cody and Waite).
    let r = x - n * 0.693_359_4 + n * 2.121_944_4e-4;
    let p = 1.987_569_1e-4;
    let p = p * r + 1.398_2e-3;
    let p = p * r + 8.333_452e-3;
    let p = p * r + 4.166_579_6e-2;
    let p = p * r + 1.666_666_6e-1;
    let p = p * r + 0.5;
    let p = p * r * r + r + 1.0;
    p * f32::from_bits(((n as i32 + 127) as u32) << 23)
}

/// Replaces numbers by their softmax and returns the logarithm of the sum of exponentials.
pub fn softmax_in_place(row: &mut [f32]) -> f32 {
    vectorize(
        #[inline(always)]
        || softmax_inline(row),
    )
}

/// As [`softmax_in_place`], for use inside vectorised loops.
#[inline(always)]
pub(crate) fn softmax_inline(row: &mut [f32]) -> f32 {
    let largest = row.iter().fold(f32::NEG_INFINITY, |m, v| m.max(*v));
    for v in row.iter_mut() {
        *v = exp_nonpositive(*v - largest);
    }
    let sum = sum(row);
    let scale = 1.0 / sum;
    for v in row.iter_mut() {
        *v *= scale;
    }
    largest + sum.ln()
}

/// A sum in sixteen lanes: plain summation is a chain that no compiler may reorder.
#[inline(always)]
pub(crate) fn sum(values: &[f32]) -> f32 {
    let mut lanes = [0.0f32; 16];
    let chunks = values.chunks_exact(16);
    let rest: f32 = chunks.remainder().iter().sum();
    for chunk in chunks {
        for (lane, v) in lanes.iter_mut().zip(chunk) {
            *lane += v;
        }
    }
    lanes.iter().sum::<f32>() + rest
}

/// A dot product in sixteen lanes.
#[inline(always)]
pub(crate) fn dot(a: &[f32], b: &[f32]) -> f32 {
    let mut lanes = [0.0f32; 16];
    let (left, right) = (a.chunks_exact(16), b.chunks_exact(16));
    let rest: f32 = left.remainder().iter().zip(right.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in left.zip(right) {
        for i in 0..16 {
            lanes[i] += x[i] * y[i];
        }
    }
    lanes.iter().sum::<f32>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_standard_library() {
        for i in 0..8700 {
            let x = -(i as f32) * 0.01;
            let (got, want) = (exp_nonpositive(x), x.exp());
            assert!((got - want).abs() <= 3e-7 * want, "exp({x}) = {got}, not {want}");
        }
        assert!(exp_nonpositive(f32::NEG_INFINITY) < 1e-37);
    }

    #[test]
    fn a_softmax_sums_to_one_and_returns_its_normaliser() {
        let mut row: Vec<f32> = (0..37).map(|i| (i as f32 * 0.7).sin() * 50.0).collect();
        let want: f64 = row.iter().map(|v| f64::from(*v).exp()).sum::<f64>().ln();
        assert!((f64::from(softmax_in_place(&mut row)) - want).abs() < 1e-4);
        assert!((row.iter().sum::<f32>() - 1.0).abs() < 1e-5);
    }
}
