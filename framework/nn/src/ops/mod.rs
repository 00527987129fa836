//! Fused operations for candle, each with an exact hand-written backward pass that a test
//! compares with finite differences.
//!
//! They exist because composed candle operations are several times slower here (every
//! gather, sum and maximum makes a tensor on one thread) and because some of candle's own
//! gradients are wrong (`scatter`, `scatter_add`, `max_pool2d`, ties of `max`).
//! CPU and `f32` only.

mod attention;
mod cross_entropy;
mod exponential;
mod interpolate;
mod layer_norm;
mod linear;
mod set_abstraction;
mod slices;

#[cfg(test)]
mod candle_operations;
#[cfg(test)]
pub(crate) mod gradient_check;

pub use attention::attention;
pub use cross_entropy::{BINS, BinTargets, cross_entropy};
pub use exponential::softmax_in_place;
pub use interpolate::interpolate;
pub use layer_norm::layer_norm;
pub use linear::{Activation, linear, linear_biased};
pub use set_abstraction::{Neighborhoods, set_abstraction};
pub(crate) use slices::{cpu_slice, grad_vec, matrix_shape, storage_slice};
