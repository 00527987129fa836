//! The volume network U and the implicit network M (method: NSE, Eq. 3 and 4).
//!
//! Per-point rows -> MLP -> maximum within each voxel of a 32^3 grid -> 3D UNet -> D, read
//! trilinearly at a query point x -> M([D(x), x]) -> winding number. The features of x are
//! the outputs of M's layers, one after the other.
//!
//! The paper's U works at 32^3 with 64 to 128 channels, some 150 GFLOP a training sample.
//! Here only the sparse first convolution works at 32^3, the rest at 16^3 and 8^3, and the
//! decoder's last step up to 32^3 is left to the trilinear reading: D(x) joins the finest
//! encoder level and the decoder at 16^3, both read at x. About 2 GFLOP forward.

use candle_core::{Result, Tensor};
use seeone_nn::Parameters;
use seeone_nn::conv3d::{Stride, TAPS, conv3d};
use seeone_nn::layers::{Linear, Norm};
use seeone_nn::ops::Activation;
use seeone_nn::volume::{Occupancy, Trilinear, sparse_conv3d, trilinear, voxel_max};

/// Voxels along an edge of the finest, the middle and the coarsest grid.
pub(crate) const SIDES: [usize; 3] = [32, 16, 8];
/// Channels of the finest, the middle and the coarsest grid.
pub(crate) const CHANNELS: [usize; 3] = [16, 48, 96];
/// Columns of the per-point MLP after its input.
const POINT_COLUMNS: [usize; 2] = [64, 32];
/// Columns of M's hidden layers.
pub(crate) const HIDDEN: usize = 128;

/// Both networks.
pub(crate) struct Network {
    point: [Linear; 2],
    /// 32^3, over the occupied voxels only.
    entry: (Tensor, Norm),
    /// 32^3 -> 16^3.
    down_16: Convolution,
    encode_16: Convolution,
    /// 16^3 -> 8^3.
    down_8: Convolution,
    encode_8: Convolution,
    /// From the channels at 8^3 to those at 16^3.
    up_16: Linear,
    decode_16: Convolution,
    head: [Linear; 3],
}

/// What U makes of a batch of clouds: two stacks of grids.
pub(crate) struct Volume {
    /// The encoder at 32^3.
    pub(crate) fine: Tensor,
    /// The decoder at 16^3.
    pub(crate) middle: Tensor,
}

/// A convolution, normalised over the channels of each voxel and rectified.
struct Convolution {
    weight: Tensor,
    norm: Norm,
    side: usize,
    stride: Stride,
}

impl Convolution {
    fn new(
        parameters: &mut Parameters,
        name: &str,
        (inputs, outputs): (usize, usize),
        side: usize,
        stride: Stride,
    ) -> Result<Self> {
        let weight = parameters.weight(&format!("{name}.weight"), TAPS * inputs, outputs, 2.0)?;
        let norm = Norm::new(parameters, &format!("{name}.norm"), outputs, Activation::Relu)?;
        Ok(Self { weight, norm, side, stride })
    }

    fn forward(&self, x: &Tensor) -> Result<Tensor> {
        self.norm.forward(&conv3d(x, &self.weight, self.side, self.stride)?)
    }
}

impl Network {
    /// A network for rows of `columns` numbers.
    pub(crate) fn new(parameters: &mut Parameters, columns: usize) -> Result<Self> {
        let [a, b] = POINT_COLUMNS;
        let [fine, middle, coarse] = CHANNELS;
        let [side_32, side_16, side_8] = SIDES;
        let (relu, identity) = (Activation::Relu, Activation::Identity);
        let p = parameters;
        Ok(Self {
            point: [
                Linear::new(p, "point.0", columns, a, relu)?,
                Linear::new(p, "point.1", a, b, identity)?,
            ],
            entry: (
                p.weight("entry.weight", b, TAPS * fine, 2.0)?,
                Norm::new(p, "entry.norm", fine, relu)?,
            ),
            down_16: Convolution::new(p, "down_16", (fine, middle), side_32, Stride::Two)?,
            encode_16: Convolution::new(p, "encode_16", (middle, middle), side_16, Stride::One)?,
            down_8: Convolution::new(p, "down_8", (middle, coarse), side_16, Stride::Two)?,
            encode_8: Convolution::new(p, "encode_8", (coarse, coarse), side_8, Stride::One)?,
            up_16: Linear::new(p, "up_16", coarse, middle, identity)?,
            decode_16: Convolution::new(p, "decode_16", (middle, middle), side_16, Stride::One)?,
            head: [
                Linear::new(p, "head.0", fine + middle + 3, HIDDEN, relu)?,
                Linear::new(p, "head.1", HIDDEN, HIDDEN, relu)?,
                Linear::new(p, "head.2", HIDDEN, 1, identity)?,
            ],
        })
    }

    /// U: the rows of all points of a batch (N x columns), sorted into voxels of 32^3.
    pub(crate) fn volume(&self, rows: &Tensor, occupancy: &Occupancy) -> Result<Volume> {
        let points = self.point[1].forward(&self.point[0].forward(rows)?)?;
        let voxels = voxel_max(&points, occupancy)?;
        let fine = self.entry.1.forward(&sparse_conv3d(&voxels, &self.entry.0, occupancy)?)?;
        let skip = self.encode_16.forward(&self.down_16.forward(&fine)?)?;
        let coarse = self.encode_8.forward(&self.down_8.forward(&skip)?)?;
        let up = trilinear(&self.up_16.forward(&coarse)?, &voxel_centres(occupancy.batch()))?;
        let middle = self.decode_16.forward(&(skip + up)?)?;
        Ok(Volume { fine, middle })
    }

    /// M at one set of queries a cloud: the outputs of its layers, each Q rows.
    pub(crate) fn query(&self, volume: &Volume, queries: &[&[[f32; 3]]]) -> Result<[Tensor; 3]> {
        let fine = trilinear(&volume.fine, &Trilinear::new(queries, SIDES[0]))?;
        let middle = trilinear(&volume.middle, &Trilinear::new(queries, SIDES[1]))?;
        let count = queries.iter().map(|set| set.len()).sum::<usize>();
        let x: Vec<f32> =
            queries.iter().flat_map(|set| set.iter().flatten()).map(|v| 2.0 * (v - 0.5)).collect();
        let x = Tensor::from_vec(x, (count, 3), fine.device())?;
        let first = self.head[0].forward(&Tensor::cat(&[&fine, &middle, &x], 1)?.contiguous()?)?;
        let second = self.head[1].forward(&first)?;
        let winding = self.head[2].forward(&second)?;
        Ok([first, second, winding])
    }
}

/// Where the voxel centres of 16^3 lie among those of 8^3, for each grid of a batch.
fn voxel_centres(batch: usize) -> Trilinear {
    let side = SIDES[1];
    let centre = |i: usize| (i as f32 + 0.5) / side as f32;
    let centres: Vec<[f32; 3]> = (0..side.pow(3))
        .map(|i| [centre(i % side), centre(i / side % side), centre(i / side / side)])
        .collect();
    Trilinear::new(&vec![centres.as_slice(); batch], SIDES[2])
}
