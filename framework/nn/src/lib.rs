//! Blocks shared by the learned plugins: point sampling, fused operations with exact
//! gradients for candle, and what trains and stores a network.
//!
//! Clouds of one batch are stacked: a batch of `B` clouds of `N` points with `C` features
//! is one matrix of `B * N` rows and `C` columns, and index tables count rows of it.

pub mod card;
mod chart;
pub mod checkpoint;
pub mod conv3d;
pub mod curve;
pub mod layers;
pub mod matmul;
pub mod ops;
pub mod optimizer;
pub mod parameters;
pub mod sampling;
pub mod schedule;
pub mod train;
pub mod volume;
pub mod weights;

pub use card::{Card, WeightsEntry};
pub use parameters::Parameters;
pub use train::{Plan, Progress, TrainError};
