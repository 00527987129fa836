//! What every room of the house shares: poses, clouds, meshes, cameras, the robot model,
//! geometry on them, and the files they are kept in.
//!
//! SI units throughout (metres, radians, seconds, newtons). Frames are named in the
//! documentation of whatever carries them. This crate knows neither the ECS, nor candle,
//! nor any physics engine.

pub mod camera;
pub mod cloud;
pub mod diagnostic;
pub mod extremes;
pub mod formats;
pub mod frames;
pub mod head;
pub mod hook;
pub mod mesh;
pub mod pose;
pub mod random;
pub mod robot;
pub mod similarity_fit;
pub mod vectorize;
pub mod winding;

pub use camera::{DepthImage, Intrinsics};
pub use cloud::Cloud;
pub use diagnostic::{Diagnostic, Place};
pub use extremes::extremes;
pub use head::HeadSize;
pub use hook::Peg;
pub use mesh::TriangleMesh;
pub use pose::{Pose, Similarity};
