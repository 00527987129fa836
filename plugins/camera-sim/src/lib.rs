//! Kind `camera`, twice: `camera-sim` looks at the simulated cell through a depth sensor
//! with the noise of a real one; `camera-file` shows a recorded cloud instead, which is
//! how a cloud from elsewhere is tried.

mod recorded;
mod simulated;

pub use recorded::RecordedCamera;
pub use simulated::SimulatedCamera;

use seeone_core::Intrinsics;
use seeone_core::pose::PoseFields;
use serde::Deserialize;

/// The table that a scene gives its camera.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Configuration {
    /// The camera's frame in `world`: x right, y down, z forward.
    pose: PoseFields,
    /// The lens.
    intrinsics: Intrinsics,
    /// Where the target is looked for.
    crop: Crop,
    /// Whether the target is told by its colour instead, wherever it is in the picture.
    #[serde(default)]
    by_colour: bool,
    /// A recorded cloud, for `camera-file` alone.
    cloud: Option<String>,
    /// How noisy the simulated sensor is.
    #[serde(default)]
    noise: NoiseTable,
}

/// The simulated sensor's noise, against that of a real one.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct NoiseTable {
    /// The axial error, in multiples of the usual one.
    times: f64,
    /// Share of the measured pixels that are false matches.
    outliers: f64,
}

impl Default for NoiseTable {
    fn default() -> Self {
        Self { times: 1.0, outliers: 0.0 }
    }
}

/// The box in `world` that holds the target, metres.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Crop {
    centre_xy_m: [f64; 2],
    half_extents_m: [f64; 2],
    floor_m: f64,
    height_m: f64,
    /// Several objects may lie there, farther from each other than this, metres; one when it is
    /// left out.
    apart_m: Option<f64>,
}
