//! The contracts: one trait a plugin kind, the messages between them, and the C ABI by
//! which the same traits are served from a dynamic library.
//!
//! A kind's trait is small. A solver that cannot find an answer says so in its outcome;
//! an error means that the question could not be worked on at all.

pub mod abi;
pub mod alignment;
pub mod camera;
pub mod clearance;
pub mod conformance;
pub mod encoding;
pub mod error;
pub mod judge;
pub mod kind;
pub mod kinematics;
pub mod motion;
pub mod perception;
pub mod robot;
pub mod setup;
pub mod sheet;
pub mod transfer;
pub mod world;

pub use alignment::{Alignment, AlignmentOutcome, Correspondences};
pub use camera::{Camera, Observation};
pub use clearance::{Clearance, Contact, Proximity};
pub use encoding::{Encoding, Features, Field};
pub use error::PluginError;
pub use judge::{Judge, Measure, Verdict};
pub use kind::Kind;
pub use kinematics::{IkOutcome, IkQuery, IkStatus, Kinematics};
pub use motion::{
    Action, JointTrajectory, KeyPose, Motion, MotionOutcome, MotionTask, Program, Step,
};
pub use perception::{CanonicalCloud, Perception};
pub use robot::{Felt, GripperCommand, Robot, RobotSample, RobotState, Watch};
pub use setup::Setup;
pub use transfer::{Candidate, Transfer, TransferTask};
pub use world::{Surface, World, WorldState};
