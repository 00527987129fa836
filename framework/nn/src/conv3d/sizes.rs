//! The sizes of a convolution and what follows from them: where in a zero-padded grid the
//! neighbourhood of each output voxel lies.

use super::TAPS;

/// Output voxels that make a matrix product worth its call.
const BLOCK_ROWS: usize = 256;

/// Sizes of one convolution.
#[derive(Clone, Copy)]
pub(super) struct Sizes {
    pub(super) batch: usize,
    /// Voxels along an edge of the input.
    pub(super) side: usize,
    /// Voxels along an edge of the output.
    pub(super) out: usize,
    pub(super) channels: usize,
    pub(super) kernels: usize,
    pub(super) step: usize,
}

impl Sizes {
    /// Numbers in one grid of the input.
    pub(super) fn grid(&self) -> usize {
        self.side.pow(3) * self.channels
    }

    /// Columns of the matrix of neighbourhoods.
    pub(super) fn columns(&self) -> usize {
        TAPS * self.channels
    }

    /// Rows of the output in one plane of constant z.
    pub(super) fn plane(&self) -> usize {
        self.out * self.out
    }

    /// The blocks of one grid as ranges of whole output planes.
    pub(super) fn blocks(&self) -> impl Iterator<Item = std::ops::Range<usize>> + use<> {
        let (out, planes) = (self.out, BLOCK_ROWS.div_ceil(self.plane()));
        (0..out).step_by(planes).map(move |z| z..(z + planes).min(out))
    }

    /// Start of row `(z, y)` in the padded grid, in padded indices.
    fn padded_row(&self, z: usize, y: usize) -> usize {
        (z * (self.side + 2) + y) * (self.side + 2) * self.channels
    }

    /// Calls `visit(start in the padded grid, start in the grid)` for each row of voxels.
    fn rows(&self, mut visit: impl FnMut(usize, usize)) {
        for i in 0..self.side * self.side {
            let padded = self.padded_row(i / self.side + 1, i % self.side + 1) + self.channels;
            visit(padded, i * self.side * self.channels);
        }
    }

    /// One grid with a border of zeros.
    pub(super) fn pad(&self, grid: &[f32]) -> Vec<f32> {
        let mut padded = vec![0.0; (self.side + 2).pow(3) * self.channels];
        let length = self.side * self.channels;
        self.rows(|to, from| padded[to..to + length].copy_from_slice(&grid[from..from + length]));
        padded
    }

    /// Takes the border off.
    pub(super) fn crop(&self, padded: &[f32], grid: &mut [f32]) {
        let length = self.side * self.channels;
        self.rows(|from, to| grid[to..to + length].copy_from_slice(&padded[from..from + length]));
    }

    /// Calls `visit(start in the padded grid)` for every run of three taps of every output
    /// voxel of a block, in the order of the matrix of neighbourhoods.
    fn runs(&self, planes: std::ops::Range<usize>, mut visit: impl FnMut(usize)) {
        for z in planes {
            for y in 0..self.out {
                let starts: [usize; 9] = std::array::from_fn(|tap| {
                    self.padded_row(z * self.step + tap / 3, y * self.step + tap % 3)
                });
                for x in 0..self.out {
                    for start in starts {
                        visit(start + x * self.step * self.channels);
                    }
                }
            }
        }
    }

    /// Fills `columns` with the neighbourhoods of a block.
    pub(super) fn gather(
        &self,
        padded: &[f32],
        planes: std::ops::Range<usize>,
        columns: &mut Vec<f32>,
    ) {
        let run = 3 * self.channels;
        columns.clear();
        self.runs(planes, |start| columns.extend_from_slice(&padded[start..start + run]));
    }

    /// Adds the gradients of a block's neighbourhoods to those of the padded grid.
    pub(super) fn scatter(
        &self,
        columns: &[f32],
        planes: std::ops::Range<usize>,
        padded: &mut [f32],
    ) {
        let run = 3 * self.channels;
        let mut chunks = columns.chunks_exact(run);
        self.runs(planes, |start| {
            let from = chunks.next().unwrap_or_default();
            padded[start..start + run].iter_mut().zip(from).for_each(|(to, from)| *to += from);
        });
    }
}
