//! How a world is advanced.

use nalgebra::Vector3;

/// How the world is advanced.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Substeps of a frame of 1/60 s; 0 counts as 1.
    pub substeps: usize,
    /// Gravity in world, m/s2.
    pub gravity: Vector3<f64>,
    /// Rate at which velocity decays, 1/s: air and the fabric's inner friction.
    pub velocity_damping: f64,
    /// Whether layers of the object keep apart.
    pub self_contact: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            substeps: 40,
            gravity: Vector3::new(0.0, 0.0, -9.81),
            velocity_damping: 2.0,
            self_contact: true,
        }
    }
}
