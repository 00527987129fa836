//! The hand's state along a task.

use seeone_plugin::{GripperCommand, KeyPose};

/// What the fingers do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hand {
    /// Distance between the pads, metres.
    pub(crate) opening_m: f64,
    /// Whether something is taken to be between them.
    pub(crate) holding: bool,
}

impl Hand {
    /// The hand while it approaches `key`: it cannot open further while it holds.
    pub(crate) fn approaching(self, key: &KeyPose) -> Self {
        if self.holding { self } else { Self { opening_m: key.opening_m, holding: false } }
    }

    /// The hand after `command`; what it holds is thin.
    pub(crate) fn after(self, command: Option<GripperCommand>) -> Self {
        match command {
            None => self,
            Some(GripperCommand::Close { .. }) => Self { opening_m: 0.0, holding: true },
            Some(GripperCommand::Open { opening_m }) => Self { opening_m, holding: false },
        }
    }
}
