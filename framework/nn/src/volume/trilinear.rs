//! Reading a grid between its voxels.

use crate::ops::{cpu_slice, grad_vec, matrix_shape};
use candle_core::{CpuStorage, CustomOp1, Layout, Result, Shape, Tensor, bail};

/// The eight voxels around each of a set of query points, and their weights.
#[derive(Clone, Debug, PartialEq)]
pub struct Trilinear {
    rows: usize,
    corners: Vec<([u32; 8], [f32; 8])>,
}

impl Trilinear {
    /// Neighbours of a batch of query sets (cube coordinates, one set a grid) in stacked
    /// grids of `side` voxels. Beyond the outermost voxel centres the border continues.
    pub fn new(queries: &[&[[f32; 3]]], side: usize) -> Self {
        let corners = queries
            .iter()
            .enumerate()
            .flat_map(|(grid, set)| set.iter().map(move |query| corners(grid, query, side)))
            .collect();
        Self { rows: queries.len() * side.pow(3), corners }
    }
}

fn corners(grid: usize, query: &[f32; 3], side: usize) -> ([u32; 8], [f32; 8]) {
    let at = query.map(|v| (v * side as f32 - 0.5).clamp(0.0, side.saturating_sub(1) as f32));
    let low = at.map(|v| (v as usize).min(side.saturating_sub(2)));
    let part: [f32; 3] = std::array::from_fn(|a| at[a] - low[a] as f32);
    // Bit `a` of a corner's number says whether it is the upper one along axis `a`.
    let upper = |corner: usize, a: usize| corner >> a & 1 == 1;
    let index = |corner: usize, a: usize| (low[a] + usize::from(upper(corner, a))).min(side - 1);
    let rows = std::array::from_fn(|i| {
        (((grid * side + index(i, 2)) * side + index(i, 1)) * side + index(i, 0)) as u32
    });
    let weights = std::array::from_fn(|i| {
        (0..3).map(|a| if upper(i, a) { part[a] } else { 1.0 - part[a] }).product()
    });
    (rows, weights)
}

/// Reads stacked grids (B D^3 x C) at the Q query points: Q x C, differentiable in the
/// grids.
///
/// # Errors
/// When the neighbours were found for other grids.
pub fn trilinear(grids: &Tensor, at: &Trilinear) -> Result<Tensor> {
    grids.apply_op1(ReadTrilinear { at: at.clone() })
}

struct ReadTrilinear {
    at: Trilinear,
}

impl CustomOp1 for ReadTrilinear {
    fn name(&self) -> &'static str {
        "trilinear"
    }

    fn cpu_fwd(&self, grids: &CpuStorage, layout: &Layout) -> Result<(CpuStorage, Shape)> {
        let (rows, channels) = matrix_shape(layout)?;
        if rows != self.at.rows {
            bail!("trilinear: neighbours among {} rows, grids of {rows}", self.at.rows)
        }
        let grids = cpu_slice(grids, layout)?;
        let mut read = vec![0.0; self.at.corners.len() * channels];
        for (read, (rows, weights)) in read.chunks_exact_mut(channels).zip(&self.at.corners) {
            for (row, weight) in rows.iter().zip(weights) {
                let from = &grids[*row as usize * channels..][..channels];
                read.iter_mut().zip(from).for_each(|(read, from)| *read += weight * from);
            }
        }
        Ok((CpuStorage::F32(read), (self.at.corners.len(), channels).into()))
    }

    fn bwd(&self, grids: &Tensor, _y: &Tensor, gradient: &Tensor) -> Result<Option<Tensor>> {
        let channels = grids.dim(1)?;
        let d_read = grad_vec(gradient)?;
        let mut d_grids = vec![0.0f32; grids.elem_count()];
        for (d_read, (rows, weights)) in d_read.chunks_exact(channels).zip(&self.at.corners) {
            for (row, weight) in rows.iter().zip(weights) {
                let to = &mut d_grids[*row as usize * channels..][..channels];
                to.iter_mut().zip(d_read).for_each(|(to, d)| *to += weight * d);
            }
        }
        Tensor::from_vec(d_grids, grids.shape(), grids.device()).map(Some)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ops::gradient_check::{check, variable};

    #[test]
    fn is_exact_on_a_linear_field_and_flat_beyond_the_border() {
        let side = 5usize;
        let centre = |i: usize| (i as f32 + 0.5) / side as f32;
        let field = |p: [f32; 3]| 2.0 * p[0] - p[1] + 3.0 * p[2];
        let values: Vec<f32> = (0..side.pow(3))
            .map(|i| field([centre(i % side), centre(i / side % side), centre(i / side / side)]))
            .collect();
        let grid =
            Tensor::from_vec(values, (side.pow(3), 1), &candle_core::Device::Cpu).expect("a grid");
        let queries = [[0.3, 0.5, 0.7], [0.11, 0.89, 0.5], [9.0, 0.5, 0.5], [0.9, 0.5, 0.5]];
        let read = trilinear(&grid, &Trilinear::new(&[&queries], side))
            .and_then(|t| t.flatten_all()?.to_vec1::<f32>())
            .expect("read");
        assert!((read[0] - field(queries[0])).abs() < 1e-5);
        assert!((read[1] - field(queries[1])).abs() < 1e-5);
        assert!((read[2] - read[3]).abs() < 1e-5);
    }

    #[test]
    fn gradients_agree_with_finite_differences() {
        let sets = [[[0.1, 0.7, 0.3], [1.2, 0.4, -0.3]], [[0.5, 0.5, 0.5], [0.05, 0.96, 0.61]]];
        let at = Trilinear::new(&[&sets[0], &sets[1]], 3);
        let grids = variable(1, &[2 * 27, 2]);
        check(&[&grids], || trilinear(&grids, &at));
    }
}
