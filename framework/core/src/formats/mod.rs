//! The file formats in which clouds and meshes are kept.

pub mod ply;
