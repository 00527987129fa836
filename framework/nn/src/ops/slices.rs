//! Reading the numbers of tensors inside custom operations.

use candle_core::{CpuStorage, Layout, Result, Storage, Tensor, bail};

/// The numbers of a contiguous `f32` storage.
pub(crate) fn cpu_slice<'a>(storage: &'a CpuStorage, layout: &Layout) -> Result<&'a [f32]> {
    match layout.contiguous_offsets() {
        Some((start, end)) => Ok(&storage.as_slice::<f32>()?[start..end]),
        None => bail!("a fused operation needs contiguous arguments"),
    }
}

/// As [`cpu_slice`], for the storage of a tensor.
pub(crate) fn storage_slice<'a>(storage: &'a Storage, layout: &Layout) -> Result<&'a [f32]> {
    match storage {
        Storage::Cpu(cpu) => cpu_slice(cpu, layout),
        _ => bail!("fused operations run on the CPU"),
    }
}

/// A copy of a gradient's numbers, whatever its layout.
pub(crate) fn grad_vec(gradient: &Tensor) -> Result<Vec<f32>> {
    gradient.flatten_all()?.to_vec1()
}

/// Rows and columns of a matrix.
pub(crate) fn matrix_shape(layout: &Layout) -> Result<(usize, usize)> {
    layout.shape().dims2()
}
