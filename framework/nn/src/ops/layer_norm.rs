//! Layer normalisation with an optional rectifier.

use super::exponential::{dot, sum};
use super::{Activation, cpu_slice, grad_vec, matrix_shape, storage_slice};
use candle_core::{CpuStorage, CustomOp3, Layout, Result, Shape, Tensor, bail};
use seeone_core::vectorize::vectorize;

/// Keeps rows of equal numbers finite.
const EPSILON: f32 = 1e-5;

struct LayerNorm {
    activation: Activation,
}

/// Mean and reciprocal standard deviation of a row.
#[inline(always)]
fn moments(row: &[f32]) -> (f32, f32) {
    let count = row.len() as f32;
    let mean = sum(row) / count;
    let variance = (dot(row, row) / count - mean * mean).max(0.0);
    (mean, 1.0 / (variance + EPSILON).sqrt())
}

impl CustomOp3 for LayerNorm {
    fn name(&self) -> &'static str {
        "layer_norm"
    }

    fn cpu_fwd(
        &self,
        x: &CpuStorage,
        xl: &Layout,
        scale: &CpuStorage,
        sl: &Layout,
        shift: &CpuStorage,
        hl: &Layout,
    ) -> Result<(CpuStorage, Shape)> {
        let (rows, columns) = matrix_shape(xl)?;
        let (x, scale, shift) = (cpu_slice(x, xl)?, cpu_slice(scale, sl)?, cpu_slice(shift, hl)?);
        if columns == 0 || scale.len() != columns || shift.len() != columns {
            bail!("layer norm: {columns} columns, {} scales, {} shifts", scale.len(), shift.len());
        }
        let mut y = vec![0.0; rows * columns];
        let floor = if self.activation == Activation::Relu { 0.0 } else { f32::NEG_INFINITY };
        vectorize(
            #[inline(always)]
            || {
                for (row, out) in x.chunks_exact(columns).zip(y.chunks_exact_mut(columns)) {
                    let (mean, inverse) = moments(row);
                    for (((o, v), s), t) in out.iter_mut().zip(row).zip(scale).zip(shift) {
                        *o = ((v - mean) * inverse * s + t).max(floor);
                    }
                }
            },
        );
        Ok((CpuStorage::F32(y), Shape::from((rows, columns))))
    }

    fn bwd(
        &self,
        x: &Tensor,
        scale: &Tensor,
        _shift: &Tensor,
        y: &Tensor,
        gradient: &Tensor,
    ) -> Result<(Option<Tensor>, Option<Tensor>, Option<Tensor>)> {
        let (rows, columns) = x.dims2()?;
        let mut dy = grad_vec(gradient)?;
        let (x_storage, x_layout) = x.storage_and_layout();
        let (y_storage, y_layout) = y.storage_and_layout();
        let (s_storage, s_layout) = scale.storage_and_layout();
        let x_values = storage_slice(&x_storage, x_layout)?;
        let y_values = storage_slice(&y_storage, y_layout)?;
        let scale_values = storage_slice(&s_storage, s_layout)?;
        let (mut dscale, mut dshift) = (vec![0.0f32; columns], vec![0.0f32; columns]);
        let mut normalised = vec![0.0f32; columns];
        let rectified = self.activation == Activation::Relu;
        vectorize(
            #[inline(always)]
            || {
                let rows = x_values.chunks_exact(columns).zip(y_values.chunks_exact(columns));
                for ((row, out), d) in rows.zip(dy.chunks_exact_mut(columns)) {
                    let (mean, inverse) = moments(row);
                    for i in 0..columns {
                        normalised[i] = (row[i] - mean) * inverse;
                        let passed = if rectified && out[i] <= 0.0 { 0.0 } else { d[i] };
                        dshift[i] += passed;
                        dscale[i] += passed * normalised[i];
                        d[i] = passed * scale_values[i];
                    }
                    // The two means that normalisation takes out of the incoming gradient.
                    let along_mean = sum(d) / columns as f32;
                    let along_row = dot(d, &normalised) / columns as f32;
                    for (v, n) in d.iter_mut().zip(&normalised) {
                        *v = inverse * (*v - along_mean - n * along_row);
                    }
                }
            },
        );
        let device = x.device();
        Ok((
            Some(Tensor::from_vec(dy, (rows, columns), device)?),
            Some(Tensor::from_vec(dscale, columns, device)?),
            Some(Tensor::from_vec(dshift, columns, device)?),
        ))
    }
}

/// Each row of `x` (rows x columns) brought to mean 0 and variance 1, then scaled, shifted
/// (a number per column each) and activated.
///
/// # Errors
/// When the shapes do not agree or an argument is not contiguous.
pub fn layer_norm(
    x: &Tensor,
    scale: &Tensor,
    shift: &Tensor,
    activation: Activation,
) -> Result<Tensor> {
    x.apply_op3(scale, shift, LayerNorm { activation })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ops::gradient_check::{check, variable};

    #[test]
    fn gradients_agree_with_finite_differences() {
        let (x, s, t) = (variable(1, &[5, 19]), variable(2, &[19]), variable(3, &[19]));
        check(&[&x, &s, &t], || layer_norm(&x, &s, &t, Activation::Identity));
        // Shifts far from zero on both sides keep the rectifier's kink away.
        let signs: Vec<f32> = (0..19).map(|i| if i % 3 == 0 { -30.0 } else { 30.0 }).collect();
        t.set(&Tensor::from_vec(signs, 19, x.device()).expect("shifts")).expect("set");
        check(&[&x, &s, &t], || layer_norm(&x, &s, &t, Activation::Relu));
    }

    #[test]
    fn rows_come_out_normalised() {
        let x = (variable(4, &[3, 64]).as_tensor() * 7.0).and_then(|x| x + 3.0).expect("x");
        let one = Tensor::ones(64, candle_core::DType::F32, x.device()).expect("ones");
        let zero = one.zeros_like().expect("zeros");
        let y = layer_norm(&x, &one, &zero, Activation::Identity).expect("y");
        for row in y.to_vec2::<f32>().expect("rows") {
            let mean: f32 = row.iter().sum::<f32>() / 64.0;
            let variance: f32 = row.iter().map(|v| v * v).sum::<f32>() / 64.0;
            assert!(mean.abs() < 1e-5 && (variance - 1.0).abs() < 1e-4);
        }
    }
}
