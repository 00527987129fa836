//! From points to a voxel grid and back.
//!
//! A grid of side D over the unit cube has its voxel `(z, y, x)` centred at
//! `((x, y, z) + 0.5) / D`. It is a matrix of D^3 rows, numbered `(z D + y) D + x`, by C
//! channels; the grids of a batch are stacked.

mod occupancy;
mod sparse_conv3d;
mod trilinear;
mod voxel_max;

pub use occupancy::Occupancy;
pub use sparse_conv3d::sparse_conv3d;
pub use trilinear::{Trilinear, trilinear};
pub use voxel_max::voxel_max;
