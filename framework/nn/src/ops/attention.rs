//! Multi-head self-attention among the tokens of each cloud.

use super::exponential::{dot, softmax_inline};
use super::{cpu_slice, grad_vec, matrix_shape, storage_slice};
use crate::matmul::{Matrix, MatrixMut, Store, multiply};
use candle_core::{CpuStorage, CustomOp1, Layout, Result, Shape, Tensor, bail};
use seeone_core::vectorize::vectorize;
use std::sync::{Mutex, PoisonError};

struct Attention {
    tokens: usize,
    heads: usize,
    /// Attention weights of the forward pass: cloud by cloud, head by head.
    weights: Mutex<Vec<f32>>,
}

/// Sizes of one call.
#[derive(Clone, Copy)]
struct Sizes {
    clouds: usize,
    tokens: usize,
    heads: usize,
    /// Columns of one head.
    width: usize,
}

impl Sizes {
    /// Columns of queries, keys and values together: one row of the argument.
    fn stride(self) -> usize {
        3 * self.heads * self.width
    }

    fn scale(self) -> f32 {
        1.0 / (self.width as f32).sqrt()
    }

    /// Queries (0), keys (1) or values (2) of one head of one cloud.
    fn part(self, qkv: &[f32], cloud: usize, part: usize, head: usize) -> Matrix<'_> {
        let start = self.start(cloud, part, head);
        Matrix::strided(&qkv[start..], self.tokens, self.width, self.stride())
    }

    fn part_mut(self, qkv: &mut [f32], cloud: usize, part: usize, head: usize) -> MatrixMut<'_> {
        let start = self.start(cloud, part, head);
        MatrixMut::strided(&mut qkv[start..], self.tokens, self.width, self.stride())
    }

    fn start(self, cloud: usize, part: usize, head: usize) -> usize {
        cloud * self.tokens * self.stride() + (part * self.heads + head) * self.width
    }

    /// One head of one cloud inside the result (heads side by side in each row).
    fn output(self, cloud: usize, head: usize) -> (usize, usize) {
        let stride = self.heads * self.width;
        (cloud * self.tokens * stride + head * self.width, stride)
    }
}

impl Attention {
    fn sizes(&self, rows: usize, columns: usize) -> Result<Sizes> {
        let Self { tokens, heads, .. } = *self;
        if tokens == 0
            || heads == 0
            || !rows.is_multiple_of(tokens)
            || !columns.is_multiple_of(3 * heads)
        {
            bail!("attention: {rows} x {columns} is not {heads} heads over {tokens} tokens");
        }
        Ok(Sizes { clouds: rows / tokens, tokens, heads, width: columns / (3 * heads) })
    }
}

impl CustomOp1 for Attention {
    fn name(&self) -> &'static str {
        "attention"
    }

    fn cpu_fwd(&self, qkv: &CpuStorage, layout: &Layout) -> Result<(CpuStorage, Shape)> {
        let (rows, columns) = matrix_shape(layout)?;
        let sizes = self.sizes(rows, columns)?;
        let qkv = cpu_slice(qkv, layout)?;
        let tokens = sizes.tokens;
        let mut weights = vec![0.0f32; sizes.clouds * sizes.heads * tokens * tokens];
        let mut y = vec![0.0; rows * columns / 3];
        for (block, w) in weights.chunks_exact_mut(tokens * tokens).enumerate() {
            let (cloud, head) = (block / sizes.heads, block % sizes.heads);
            let queries = sizes.part(qkv, cloud, 0, head);
            let keys = sizes.part(qkv, cloud, 1, head).transposed();
            multiply(MatrixMut::new(w, tokens, tokens), queries, keys, Store::Replace);
            let scale = sizes.scale();
            vectorize(
                #[inline(always)]
                || {
                    for row in w.chunks_exact_mut(tokens) {
                        for v in row.iter_mut() {
                            *v *= scale;
                        }
                        softmax_inline(row);
                    }
                },
            );
            let (start, stride) = sizes.output(cloud, head);
            multiply(
                MatrixMut::strided(&mut y[start..], tokens, sizes.width, stride),
                Matrix::new(w, tokens, tokens),
                sizes.part(qkv, cloud, 2, head),
                Store::Replace,
            );
        }
        *self.weights.lock().unwrap_or_else(PoisonError::into_inner) = weights;
        Ok((CpuStorage::F32(y), Shape::from((rows, columns / 3))))
    }

    fn bwd(&self, qkv: &Tensor, _y: &Tensor, gradient: &Tensor) -> Result<Option<Tensor>> {
        let (rows, columns) = qkv.dims2()?;
        let sizes = self.sizes(rows, columns)?;
        let tokens = sizes.tokens;
        let dy = grad_vec(gradient)?;
        let (storage, layout) = qkv.storage_and_layout();
        let values = storage_slice(&storage, layout)?;
        let weights = self.weights.lock().unwrap_or_else(PoisonError::into_inner);
        let mut d = vec![0.0f32; rows * columns];
        let mut dw = vec![0.0f32; tokens * tokens];
        for (block, w) in weights.chunks_exact(tokens * tokens).enumerate() {
            let (cloud, head) = (block / sizes.heads, block % sizes.heads);
            let (start, stride) = sizes.output(cloud, head);
            let dy = Matrix::strided(&dy[start..], tokens, sizes.width, stride);
            let w_matrix = Matrix::new(w, tokens, tokens);
            multiply(
                sizes.part_mut(&mut d, cloud, 2, head),
                w_matrix.transposed(),
                dy,
                Store::Replace,
            );
            let v = sizes.part(values, cloud, 2, head).transposed();
            multiply(MatrixMut::new(&mut dw, tokens, tokens), dy, v, Store::Replace);
            let scale = sizes.scale();
            vectorize(
                #[inline(always)]
                || {
                    for (d, p) in dw.chunks_exact_mut(tokens).zip(w.chunks_exact(tokens)) {
                        let mean = dot(d, p);
                        for (d, p) in d.iter_mut().zip(p) {
                            *d = p * (*d - mean) * scale;
                        }
                    }
                },
            );
            let ds = Matrix::new(&dw, tokens, tokens);
            let (queries, keys) =
                (sizes.part(values, cloud, 0, head), sizes.part(values, cloud, 1, head));
            multiply(sizes.part_mut(&mut d, cloud, 0, head), ds, keys, Store::Replace);
            multiply(
                sizes.part_mut(&mut d, cloud, 1, head),
                ds.transposed(),
                queries,
                Store::Replace,
            );
        }
        Ok(Some(Tensor::from_vec(d, (rows, columns), qkv.device())?))
    }
}

/// Scaled dot-product attention (Vaswani et al. 2017, Eq. 1) of `heads` heads.
///
/// `qkv` has a row for each token, clouds of `tokens` rows one after the other, and in each
/// row the queries of all heads, then the keys, then the values. The result has a third of
/// the columns.
///
/// # Errors
/// When the sizes do not divide.
pub fn attention(qkv: &Tensor, tokens: usize, heads: usize) -> Result<Tensor> {
    qkv.apply_op1(Attention { tokens, heads, weights: Mutex::new(Vec::new()) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ops::gradient_check::{check, variable};

    #[test]
    fn gradients_agree_with_finite_differences() {
        let qkv = variable(1, &[2 * 5, 3 * 2 * 4]);
        check(&[&qkv], || attention(&qkv, 5, 2));
        assert!(attention(&qkv, 3, 2).is_err());
    }

    #[test]
    fn clouds_do_not_see_each_other() {
        let qkv = variable(2, &[6, 12]);
        let both = attention(&qkv, 3, 2).and_then(|y| y.narrow(0, 3, 3)?.to_vec2::<f32>());
        let alone =
            qkv.narrow(0, 3, 3).and_then(|q| attention(&q.contiguous()?, 3, 2)?.to_vec2::<f32>());
        assert_eq!(both.expect("both"), alone.expect("alone"));
    }
}
