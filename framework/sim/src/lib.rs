//! The simulated world: deformable shells under gravity, contact and a gripper.

pub mod category;
pub mod cell;
mod contact;
pub mod dataset;
pub mod depth_camera;
pub mod drop;
pub mod expert;
mod grasp;
pub mod hand;
pub mod hanging;
pub mod import;
pub mod object;
pub mod object_file;
pub mod picture;
pub mod put_on;
pub mod raster;
pub mod rigid_fit;
pub mod scenery;
pub mod segmentation;
mod self_contact;
mod shell;
pub mod surroundings;
pub mod wearing;
pub mod world;
pub mod worn;

pub use contact::ellipsoid::Ellipsoid;
pub use hand::{Hand, HandState};
pub use hanging::Hanging;
pub use object::{Material, Object, ObjectFault, Region, Symmetry};
pub use surroundings::{Frictions, Head, HeadSize, Hook, Peg, Surroundings};
pub use wearing::WearError;
pub use world::{Settings, Settled, World};
