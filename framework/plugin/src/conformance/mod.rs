//! What every plugin of a kind must keep, whoever wrote it and however it is served: one
//! plain function a kind, called by the tests of the plugins and of the loader.
//!
//! A suite knows nothing of the plugin: it brings its own clouds, fields, kinematics
//! ([`Descent`]), arm ([`arm()`]) and world ([`StillWorld`]), so that a plugin is tested without
//! any other. Every answer must come within the time that a host waits; whoever may be asked to end
//! early (a robot by its watcher and by `stop`, a planner by its kinematics) must. One that never answers is the
//! loader's business, which leaves it alone.

pub mod alignment;
pub mod arm;
pub mod camera;
pub mod encoding;
pub mod kinematics;
pub mod motion;
pub mod perception;
pub mod robot;
pub mod transfer;
mod violation;
pub mod world;

pub use alignment::alignment;
pub use arm::{Descent, arm};
pub use camera::camera;
pub use encoding::encoding;
pub use kinematics::kinematics;
pub use motion::motion;
pub use perception::perception;
pub use robot::robot;
pub use transfer::transfer;
pub use violation::Violation;
pub use world::StillWorld;
