//! The maximum of each channel over the points of a voxel.

use super::Occupancy;
use crate::ops::{cpu_slice, grad_vec, matrix_shape, storage_slice};
use candle_core::{CpuStorage, CustomOp1, Layout, Result, Shape, Tensor, bail};

/// Per-point features (N x C) to the maximum of each channel over the points of each
/// occupied voxel (V x C). Of equal features the first point's takes the gradient.
///
/// # Errors
/// When `N` is not the number of points that were sorted into the voxels.
pub fn voxel_max(points: &Tensor, occupancy: &Occupancy) -> Result<Tensor> {
    points.apply_op1(VoxelMax { occupancy: occupancy.clone() })
}

struct VoxelMax {
    occupancy: Occupancy,
}

impl VoxelMax {
    /// Index into `values` of the maximum of each voxel and channel.
    fn winners(&self, values: &[f32], channels: usize) -> Vec<u32> {
        const NONE: u32 = u32::MAX;
        let mut winners = vec![NONE; self.occupancy.voxels().len() * channels];
        for (i, owner) in self.occupancy.owners().iter().enumerate() {
            let own = &mut winners[*owner as usize * channels..][..channels];
            for (c, winner) in own.iter_mut().enumerate() {
                let index = i * channels + c;
                if *winner == NONE || values[index] > values[*winner as usize] {
                    *winner = index as u32;
                }
            }
        }
        winners
    }
}

impl CustomOp1 for VoxelMax {
    fn name(&self) -> &'static str {
        "voxel_max"
    }

    fn cpu_fwd(&self, points: &CpuStorage, layout: &Layout) -> Result<(CpuStorage, Shape)> {
        let (rows, channels) = matrix_shape(layout)?;
        let points = cpu_slice(points, layout)?;
        if rows != self.occupancy.owners().len() {
            bail!("voxel max: {rows} rows for {} points", self.occupancy.owners().len())
        }
        let maxima = self.winners(points, channels).iter().map(|w| points[*w as usize]).collect();
        Ok((CpuStorage::F32(maxima), (self.occupancy.voxels().len(), channels).into()))
    }

    fn bwd(&self, points: &Tensor, _y: &Tensor, gradient: &Tensor) -> Result<Option<Tensor>> {
        let (storage, layout) = points.storage_and_layout();
        let winners = self.winners(storage_slice(&storage, layout)?, points.dim(1)?);
        let mut d_points = vec![0.0; points.elem_count()];
        for (winner, d) in winners.iter().zip(grad_vec(gradient)?) {
            d_points[*winner as usize] += d;
        }
        Tensor::from_vec(d_points, points.shape(), points.device()).map(Some)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ops::gradient_check::{check, variable};

    #[test]
    fn takes_each_channels_maximum() {
        let cloud = [[0.1, 0.1, 0.1], [0.9, 0.9, 0.9], [0.2, 0.2, 0.2]];
        let occupancy = Occupancy::new(&[&cloud], 2);
        let features = [[1f32, -5.0], [7.0, 8.0], [3.0, -9.0]];
        let features = Tensor::new(&features, &candle_core::Device::Cpu).expect("features");
        let maxima = voxel_max(&features, &occupancy).and_then(|m| m.to_vec2::<f32>());
        assert_eq!(maxima.expect("maxima"), [[3.0, -5.0], [7.0, 8.0]]);
        assert!(voxel_max(&features.narrow(0, 0, 2).expect("two"), &occupancy).is_err());
    }

    #[test]
    fn gradients_agree_with_finite_differences() {
        // Pairs of points share a voxel, and are far from a tie.
        let clouds = [[[0.1; 3], [0.15; 3], [0.9; 3]], [[0.1; 3], [0.8; 3], [0.9; 3]]];
        let occupancy = Occupancy::new(&[&clouds[0], &clouds[1]], 2);
        let x = variable(5, &[6, 3]);
        check(&[&x], || voxel_max(&x, &occupancy));
    }
}
