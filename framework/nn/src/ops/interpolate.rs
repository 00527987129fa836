//! Weighted sums of a few rows: features carried from coarse to fine points.

use super::{cpu_slice, grad_vec, matrix_shape};
use crate::sampling::Interpolation;
use candle_core::{CpuStorage, CustomOp1, Layout, Result, Shape, Tensor, bail};
use seeone_core::vectorize::vectorize;

struct Interpolate {
    table: Interpolation,
}

impl CustomOp1 for Interpolate {
    fn name(&self) -> &'static str {
        "interpolate"
    }

    fn cpu_fwd(&self, f: &CpuStorage, fl: &Layout) -> Result<(CpuStorage, Shape)> {
        let (sources, columns) = matrix_shape(fl)?;
        let f = cpu_slice(f, fl)?;
        if self.table.rows.iter().flatten().any(|i| *i as usize >= sources) {
            bail!("interpolate: a row is out of range");
        }
        let targets = self.table.rows.len();
        let mut y = vec![0.0; targets * columns];
        vectorize(
            #[inline(always)]
            || {
                let entries = self.table.rows.iter().zip(&self.table.weights);
                for (out, (rows, weights)) in y.chunks_exact_mut(columns).zip(entries) {
                    let [a, b, c] = rows.map(|r| &f[r as usize * columns..][..columns]);
                    for i in 0..columns {
                        out[i] = weights[0] * a[i] + weights[1] * b[i] + weights[2] * c[i];
                    }
                }
            },
        );
        Ok((CpuStorage::F32(y), Shape::from((targets, columns))))
    }

    fn bwd(&self, f: &Tensor, _y: &Tensor, gradient: &Tensor) -> Result<Option<Tensor>> {
        let (sources, columns) = f.dims2()?;
        let dy = grad_vec(gradient)?;
        let mut df = vec![0.0f32; sources * columns];
        vectorize(
            #[inline(always)]
            || {
                let entries = self.table.rows.iter().zip(&self.table.weights);
                for (d, (rows, weights)) in dy.chunks_exact(columns).zip(entries) {
                    for (row, weight) in rows.iter().zip(weights) {
                        let target = &mut df[*row as usize * columns..][..columns];
                        for (t, v) in target.iter_mut().zip(d) {
                            *t += weight * v;
                        }
                    }
                }
            },
        );
        Ok(Some(Tensor::from_vec(df, (sources, columns), f.device())?))
    }
}

/// Rows of `f` (sources x columns) mixed by `table`: targets x columns.
///
/// # Errors
/// When the table names a row that is not there, or `f` has no column.
pub fn interpolate(f: &Tensor, table: Interpolation) -> Result<Tensor> {
    if f.dims2()?.1 == 0 {
        bail!("interpolate: no columns");
    }
    f.apply_op1(Interpolate { table })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ops::gradient_check::{check, variable};

    #[test]
    fn gradients_agree_with_finite_differences() {
        let f = variable(1, &[4, 6]);
        let table = Interpolation {
            rows: vec![[0, 1, 2], [3, 3, 1], [2, 0, 3]],
            weights: vec![[0.2, 0.3, 0.5], [0.6, 0.1, 0.3], [1.0, 0.0, 0.0]],
        };
        check(&[&f], || interpolate(&f, table.clone()));
        let wrong = Interpolation { rows: vec![[4, 0, 0]], weights: vec![[1.0, 0.0, 0.0]] };
        assert!(interpolate(&f, wrong).is_err());
    }
}
