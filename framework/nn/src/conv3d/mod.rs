//! Convolution over dense voxel grids: 3 x 3 x 3 taps, zero padding 1, channels last.
//!
//! candle has none. The neighbourhoods of a block of output voxels are gathered into a
//! matrix and multiplied with the weights, so that the work is one matrix product a block
//! and the scratch memory stays within the cache. In a padded channels-last grid the three
//! taps along x lie side by side, so a neighbourhood is nine copies, not 27.

mod sizes;

use crate::matmul::{Matrix, MatrixMut, Store, multiply};
use crate::ops::{cpu_slice, grad_vec, matrix_shape, storage_slice};
use candle_core::{CpuStorage, CustomOp2, Layout, Result, Shape, Tensor, bail};
use sizes::Sizes;

/// Taps of the kernel.
pub const TAPS: usize = 27;

/// Distance between the inputs of neighbouring outputs, in voxels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stride {
    /// The output grid is the input grid.
    One,
    /// Every second voxel along each axis: an even side is halved.
    Two,
}

/// Convolves stacked cubic grids of `side` voxels: `x` (B D^3 rows, voxels in z, y, x order,
/// by C channels) with `weight` (27 C rows, ordered by tap dz, dy, dx and then channel, by K)
/// to B D'^3 rows by K, where `D' = D / stride`. Differentiable in both.
///
/// # Errors
/// When the shapes do not fit together or an argument is not contiguous.
pub fn conv3d(x: &Tensor, weight: &Tensor, side: usize, stride: Stride) -> Result<Tensor> {
    x.apply_op2(weight, Conv3d { side, stride })
}

struct Conv3d {
    side: usize,
    stride: Stride,
}

impl Conv3d {
    fn sizes(&self, x: &Layout, weight: &Layout) -> Result<Sizes> {
        let ((rows, channels), (weight_rows, kernels)) = (matrix_shape(x)?, matrix_shape(weight)?);
        let step = if self.stride == Stride::One { 1 } else { 2 };
        let (side, voxels) = (self.side, self.side.pow(3));
        if side == 0 || side % step != 0 || rows % voxels != 0 {
            bail!("conv3d: {rows} rows are no grids of side {side} for a stride of {step}")
        }
        if weight_rows != TAPS * channels {
            bail!("conv3d: {weight_rows} weight rows for {channels} channels")
        }
        Ok(Sizes { batch: rows / voxels, side, out: side / step, channels, kernels, step })
    }
}

impl CustomOp2 for Conv3d {
    fn name(&self) -> &'static str {
        "conv3d"
    }

    fn cpu_fwd(
        &self,
        x: &CpuStorage,
        xl: &Layout,
        weight: &CpuStorage,
        wl: &Layout,
    ) -> Result<(CpuStorage, Shape)> {
        let sizes = self.sizes(xl, wl)?;
        let (x, weight) = (cpu_slice(x, xl)?, cpu_slice(weight, wl)?);
        let weight = Matrix::new(weight, sizes.columns(), sizes.kernels);
        let mut y = vec![0.0; sizes.batch * sizes.out.pow(3) * sizes.kernels];
        let mut rest = y.as_mut_slice();
        let mut columns = Vec::new();
        for grid in x.chunks_exact(sizes.grid()) {
            let padded = sizes.pad(grid);
            for planes in sizes.blocks() {
                let rows = planes.len() * sizes.plane();
                sizes.gather(&padded, planes, &mut columns);
                let (block, after) = rest.split_at_mut(rows * sizes.kernels);
                rest = after;
                let target = MatrixMut::new(block, rows, sizes.kernels);
                multiply(
                    target,
                    Matrix::new(&columns, rows, sizes.columns()),
                    weight,
                    Store::Replace,
                );
            }
        }
        Ok((CpuStorage::F32(y), (sizes.batch * sizes.out.pow(3), sizes.kernels).into()))
    }

    fn bwd(
        &self,
        x: &Tensor,
        weight: &Tensor,
        _y: &Tensor,
        gradient: &Tensor,
    ) -> Result<(Option<Tensor>, Option<Tensor>)> {
        let sizes = self.sizes(x.layout(), weight.layout())?;
        let (x_storage, x_layout) = x.storage_and_layout();
        let (w_storage, w_layout) = weight.storage_and_layout();
        let values = storage_slice(&x_storage, x_layout)?;
        let transposed =
            Matrix::new(storage_slice(&w_storage, w_layout)?, sizes.columns(), sizes.kernels)
                .transposed();
        let dy = grad_vec(gradient)?;
        let mut dy_blocks = dy.as_slice();
        let mut dx = vec![0.0; values.len()];
        let mut dw = vec![0.0; sizes.columns() * sizes.kernels];
        let (mut columns, mut d_columns) = (Vec::new(), Vec::new());
        for (grid, d_grid) in
            values.chunks_exact(sizes.grid()).zip(dx.chunks_exact_mut(sizes.grid()))
        {
            let padded = sizes.pad(grid);
            let mut d_padded = vec![0.0; padded.len()];
            for planes in sizes.blocks() {
                let rows = planes.len() * sizes.plane();
                let (dy, after) = dy_blocks.split_at(rows * sizes.kernels);
                dy_blocks = after;
                let dy = Matrix::new(dy, rows, sizes.kernels);
                sizes.gather(&padded, planes.clone(), &mut columns);
                let neighbours = Matrix::new(&columns, rows, sizes.columns());
                let target = MatrixMut::new(&mut dw, sizes.columns(), sizes.kernels);
                multiply(target, neighbours.transposed(), dy, Store::Add);
                d_columns.resize(columns.len(), 0.0);
                let target = MatrixMut::new(&mut d_columns, rows, sizes.columns());
                multiply(target, dy, transposed, Store::Replace);
                sizes.scatter(&d_columns, planes, &mut d_padded);
            }
            sizes.crop(&d_padded, d_grid);
        }
        let device = x.device();
        Ok((
            Some(Tensor::from_vec(dx, x.shape(), device)?),
            Some(Tensor::from_vec(dw, weight.shape(), device)?),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ops::gradient_check::{check, variable};

    /// The definition, tap by tap, for one grid.
    fn direct(x: &[f32], w: &[f32], (side, c, k): (usize, usize, usize), step: usize) -> Vec<f32> {
        let out = side / step;
        let mut y = vec![0.0; out.pow(3) * k];
        for (i, sum) in y.iter_mut().enumerate() {
            let (voxel, kernel) = (i / k, i % k);
            let at = [voxel / out / out, voxel / out % out, voxel % out];
            for tap in 0..TAPS {
                let offset = [tap / 9, tap / 3 % 3, tap % 3];
                let from: [usize; 3] = std::array::from_fn(|a| at[a] * step + offset[a]);
                // Indices are those of the padded grid: 0 and side + 1 are its border.
                if from.iter().all(|v| (1..=side).contains(v)) {
                    let voxel = ((from[0] - 1) * side + from[1] - 1) * side + from[2] - 1;
                    for ch in 0..c {
                        *sum += x[voxel * c + ch] * w[(tap * c + ch) * k + kernel];
                    }
                }
            }
        }
        y
    }

    #[test]
    fn agrees_with_the_definition_also_over_several_blocks() {
        let numbers =
            |t: &Tensor| t.flatten_all().and_then(|t| t.to_vec1::<f32>()).expect("numbers");
        for (side, stride) in [(4usize, Stride::One), (6, Stride::Two), (20, Stride::One)] {
            let (x, w) = (variable(1, &[side.pow(3), 2]), variable(2, &[TAPS * 2, 3]));
            let step = if stride == Stride::One { 1 } else { 2 };
            let wanted = direct(&numbers(&x), &numbers(&w), (side, 2, 3), step);
            let got = numbers(&conv3d(&x, &w, side, stride).expect("a result"));
            assert_eq!(wanted.len(), got.len());
            let worst = wanted.iter().zip(&got).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
            assert!(worst < 1e-4, "{worst} at side {side}");
        }
    }

    #[test]
    fn gradients_agree_with_finite_differences() {
        for stride in [Stride::One, Stride::Two] {
            let (x, w) = (variable(1, &[2 * 64, 2]), variable(2, &[TAPS * 2, 3]));
            check(&[&x, &w], || conv3d(&x, &w, 4, stride));
        }
    }

    #[test]
    fn refuses_shapes_that_do_not_fit() {
        let w = variable(2, &[TAPS * 2, 3]);
        assert!(conv3d(&variable(1, &[64, 3]), &w, 4, Stride::One).is_err());
        assert!(conv3d(&variable(1, &[65, 2]), &w, 4, Stride::One).is_err());
        assert!(conv3d(&variable(1, &[125, 2]), &w, 5, Stride::Two).is_err());
    }
}
