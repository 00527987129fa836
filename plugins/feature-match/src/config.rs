//! The plugin's table of the configuration.

use seeone_plugin::PluginError;
use serde::Deserialize;

/// More poses than this make a table a mistake: the default grid has 39.
const MOST_POSES: usize = 20_000;

/// The table; lengths in canonical units, of which a cap's box edge is one.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Config {
    /// Search along canonical x.
    pub x: Axis,
    /// Search along canonical y.
    pub y: Axis,
    /// Search along canonical z.
    pub z: Axis,
    /// Weight of the prior: the loss at one spread along one axis.
    pub prior: f64,
    /// Temperature of the soft minimum, in units of the loss.
    pub temperature: f64,
    /// Distance within which a predicted point speaks for the sheet to snap onto.
    pub snap_radius: f64,
    /// Number of such points below which nothing is snapped.
    pub snap_points: usize,
    /// Local minima of the grid that are offered beside the soft minimum.
    pub alternatives: usize,
}

/// One direction of the search.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Axis {
    /// How far the search goes to either side.
    pub reach: f64,
    /// Number of steps over both sides; odd, so that the demonstrated pose is one.
    pub steps: usize,
    /// How far corresponding poses lie apart within the category.
    pub spread: f64,
}

impl Default for Axis {
    /// An axis that is not searched.
    fn default() -> Self {
        Self { reach: 0.0, steps: 1, spread: 0.01 }
    }
}

impl Default for Config {
    fn default() -> Self {
        Self {
            x: Axis::default(),
            y: Axis { reach: 0.02, steps: 3, spread: 0.015 },
            z: Axis { reach: 0.12, steps: 13, spread: 0.05 },
            prior: 0.001,
            temperature: 0.01,
            snap_radius: 0.1,
            snap_points: 12,
            alternatives: 2,
        }
    }
}

impl Config {
    /// The axes in the order x, y, z.
    pub fn axes(&self) -> [Axis; 3] {
        [self.x, self.y, self.z]
    }

    /// The same, once its numbers are known to make sense.
    pub fn checked(self) -> Result<Self, PluginError> {
        for (name, axis) in ["x", "y", "z"].into_iter().zip(self.axes()) {
            axis.check(name)?;
        }
        if self.axes().iter().map(|a| a.steps).product::<usize>() > MOST_POSES {
            return refuse(format!("the grid has more than {MOST_POSES} poses"));
        }
        if !self.prior.is_finite() || self.prior < 0.0 {
            return refuse(format!("prior is {}, not a number from 0 upwards", self.prior));
        }
        positive("temperature", self.temperature)?;
        positive("snap_radius", self.snap_radius)?;
        if self.snap_points == 0 {
            return refuse("snap_points must be at least 1".into());
        }
        Ok(self)
    }
}

impl Axis {
    fn check(&self, name: &str) -> Result<(), PluginError> {
        positive(&format!("{name}.spread"), self.spread)?;
        if self.steps.is_multiple_of(2) || self.steps > MOST_POSES {
            return refuse(format!("{name}.steps is {}, not an odd number", self.steps));
        }
        if !self.reach.is_finite() || self.reach < 0.0 || (self.reach == 0.0) != (self.steps == 1) {
            return refuse(format!(
                "{name}.reach is {} with {} steps; one step reaches 0, more reach further",
                self.reach, self.steps
            ));
        }
        Ok(())
    }
}

fn positive(name: &str, value: f64) -> Result<(), PluginError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        refuse(format!("{name} is {value}, not a positive number"))
    }
}

fn refuse<T>(cause: String) -> Result<T, PluginError> {
    Err(PluginError::Configuration(cause))
}
