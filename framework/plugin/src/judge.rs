//! The verdict. In a simulated cell physics gives it; a cell that nobody can judge says so.

use crate::PluginError;

/// What a skill counts as success.
#[derive(Clone, Debug, PartialEq)]
pub enum Measure {
    /// Mean vertex distance to the worn state below this share of the diameter `d`
    /// (method: Eq. 12).
    Worn {
        /// Share of the object's diameter.
        tolerance_d: f64,
    },
    /// On the hook by itself: let go, at rest for some seconds, touching the peg and neither
    /// table nor hand.
    Hung,
    /// In the hand, clear of the table, with its centre of mass near a frame of the scene.
    Held {
        /// The frame's name.
        frame: String,
        /// How near to the frame's origin, metres.
        within_m: f64,
    },
}

impl Measure {
    /// Its name in skill files.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Worn { .. } => "worn",
            Self::Hung => "hung",
            Self::Held { .. } => "held",
        }
    }
}

/// How a run ended, judged by the world and never by the plan.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Verdict {
    /// Held after the lift (method: Eq. 11).
    pub grasped: bool,
    /// Within the skill's tolerance.
    pub success: bool,
    /// Mean vertex distance to the worn state, metres, when the object came to rest; this and
    /// what follows are `None` where wearing was not to be judged.
    pub error_m: Option<f64>,
    /// The same as a share of the diameter.
    pub error_d: Option<f64>,
    /// Angle between the worn and the reached up axis, degrees.
    pub tilt_deg: Option<f64>,
    /// The part of it that is the brim's: up positive, degrees.
    pub nose_up_deg: Option<f64>,
    /// Angle about the up axis between worn and reached, degrees.
    pub yaw_deg: Option<f64>,
    /// Why it failed, or by how much it succeeded.
    pub reason: String,
}

/// Whoever can tell how the cell really is; linked plugins of a simulated cell only.
pub trait Judge: Send {
    /// Called after the lift: is the object held?
    ///
    /// # Errors
    /// When the world cannot be judged.
    fn grasped(&mut self) -> Result<bool, PluginError>;

    /// Called after the last stage: lets the world settle, then judges it.
    ///
    /// # Errors
    /// When the world cannot be judged.
    fn judge(&mut self, measure: &Measure, grasped: bool) -> Result<Verdict, PluginError>;

    /// The vertices of the object, or of all objects one after another, in `world` now, for the
    /// recording alone.
    fn object(&self) -> Vec<[f64; 3]>;
}
