//! The kinds of plugins.

use std::fmt;
use std::str::FromStr;

/// What a plugin is for; one trait each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// Depth camera -> observation.
    Camera,
    /// Cloud -> canonical cloud.
    Perception,
    /// Canonical cloud -> field of features.
    Encoding,
    /// Point correspondences -> similarity.
    Alignment,
    /// Field and demonstration -> ranked canonical gripper poses.
    Transfer,
    /// Tool pose -> joint positions.
    Kinematics,
    /// Key poses -> program of joint trajectories.
    Motion,
    /// Program -> moved robot.
    Robot,
}

impl Kind {
    /// Every kind, in the order in which a run meets them.
    pub const ALL: [Kind; 8] = [
        Kind::Camera,
        Kind::Perception,
        Kind::Encoding,
        Kind::Alignment,
        Kind::Transfer,
        Kind::Kinematics,
        Kind::Motion,
        Kind::Robot,
    ];

    /// The name used in files and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Camera => "camera",
            Kind::Perception => "perception",
            Kind::Encoding => "encoding",
            Kind::Alignment => "alignment",
            Kind::Transfer => "transfer",
            Kind::Kinematics => "kinematics",
            Kind::Motion => "motion",
            Kind::Robot => "robot",
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Kind {
    type Err = ();

    fn from_str(name: &str) -> Result<Self, ()> {
        Kind::ALL.into_iter().find(|kind| kind.name() == name).ok_or(())
    }
}
