//! The simulated world that robot and camera plugins share, as the host offers it to them.

use crate::{GripperCommand, PluginError};
use nalgebra::Vector3;
use seeone_core::{Pose, TriangleMesh};

/// The hand in the world at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorldState {
    /// Seconds of simulated time.
    pub time_s: f64,
    /// Seconds of one frame, the step of [`World::advance`].
    pub frame_s: f64,
    /// Distance between the pads, metres.
    pub opening_m: f64,
    /// Whether the fingers moved in the last frame.
    pub fingers_move: bool,
    /// Whether the fingers stopped against something.
    pub pads_feel_load: bool,
    /// What the hand gives to what it holds, newtons in `world`; zero when it holds nothing.
    pub load_n: Vector3<f64>,
}

/// A surface that a camera may see.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// In `world`, metres.
    pub mesh: TriangleMesh,
    /// Whether it has the colour by which the objects to be taken are told from all else: what a
    /// camera with colours sees.
    pub is_object: bool,
}

/// A simulated world with one hand in it, moved by a robot plugin and seen by a camera plugin.
/// What a judge knows of it is no part of this.
pub trait World: Send + Sync {
    /// How it is now.
    ///
    /// # Errors
    /// When the world broke down.
    fn state(&self) -> Result<WorldState, PluginError>;

    /// Puts the hand at a pose (tool frame in `world`) at once.
    ///
    /// # Errors
    /// As [`World::state`].
    fn place_hand(&self, pose: &Pose) -> Result<(), PluginError>;

    /// One frame, at whose end the hand is at `pose` (tool frame in `world`).
    ///
    /// # Errors
    /// When the simulation diverged, or as [`World::state`].
    fn advance(&self, pose: &Pose) -> Result<(), PluginError>;

    /// Closes the fingers until they press with `force_n`, over the coming frames.
    ///
    /// # Errors
    /// As [`World::state`].
    fn close_fingers(&self, force_n: f64) -> Result<(), PluginError>;

    /// Lets go at once and opens the fingers to `opening_m` over the coming frames.
    ///
    /// # Errors
    /// As [`World::state`].
    fn open_fingers(&self, opening_m: f64) -> Result<(), PluginError>;

    /// Begins what a gripper is told.
    ///
    /// # Errors
    /// [`PluginError::Input`] for a force that is not positive or an opening that is negative, or
    /// as [`World::state`].
    fn grip(&self, command: GripperCommand) -> Result<(), PluginError> {
        match command {
            GripperCommand::Close { force_n } if force_n.is_finite() && force_n > 0.0 => {
                self.close_fingers(force_n)
            }
            GripperCommand::Open { opening_m } if opening_m.is_finite() && opening_m >= 0.0 => {
                self.open_fingers(opening_m)
            }
            other => Err(PluginError::Input(format!("{other:?} is no command to grip"))),
        }
    }

    /// The surfaces that a camera may see, in `world`, without the robot's.
    ///
    /// # Errors
    /// As [`World::state`].
    fn surfaces(&self) -> Result<Vec<Surface>, PluginError>;
}
