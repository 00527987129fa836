//! `my-plugin`, a plugin of kind `encoding`: the features of the nearest observed points,
//! weighted by their nearness.

use nalgebra::Point3;
use seeone_plugin::{CanonicalCloud, Encoding, Features, Field, PluginError, Setup};
use serde::Deserialize;

seeone_plugin::export_plugins! {
    Encoding "my-plugin" => MyPlugin::from_setup,
}

/// Encodes by interpolation. Its fields are its table in a robot file, `[config.encoding]`.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MyPlugin {
    /// Distance over which a point's influence falls off, canonical units.
    fall_off: f64,
}

impl Default for MyPlugin {
    fn default() -> Self {
        Self { fall_off: 0.03 }
    }
}

impl MyPlugin {
    /// From its table.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for an unknown key or a number out of range.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        let plugin: Self = setup.configuration()?;
        if !(plugin.fall_off > 0.0 && plugin.fall_off <= 1.0) {
            let told = format!("fall_off is {}, not above 0 and up to 1", plugin.fall_off);
            return Err(PluginError::Configuration(told));
        }
        Ok(plugin)
    }
}

impl Encoding for MyPlugin {
    fn encode(&mut self, cloud: &CanonicalCloud) -> Result<Box<dyn Field>, PluginError> {
        cloud.check().map_err(PluginError::Input)?;
        if cloud.is_empty() {
            return Err(PluginError::Input("the cloud is empty".into()));
        }
        Ok(Box::new(Interpolated { cloud: cloud.clone(), fall_off: self.fall_off }))
    }
}

/// The field of one cloud.
struct Interpolated {
    cloud: CanonicalCloud,
    fall_off: f64,
}

impl Field for Interpolated {
    fn features(&self, queries: &[Point3<f64>]) -> Features {
        let width = self.cloud.feature_width;
        let mut values = Vec::with_capacity(queries.len() * width);
        for query in queries {
            let mut sum = vec![0.0; width];
            let mut total = 0.0;
            for (i, point) in self.cloud.nocs.iter().enumerate() {
                let near = (query - point).norm_squared() / self.fall_off.powi(2);
                let weight = 1.0 / (1e-6 + near * near);
                let row = &self.cloud.features[i * width..(i + 1) * width];
                sum.iter_mut().zip(row).for_each(|(s, f)| *s += weight * f64::from(*f));
                total += weight;
            }
            values.extend(sum.iter().map(|s| (s / total) as f32));
        }
        Features { width, values }
    }

    fn winding(&self, _queries: &[Point3<f64>]) -> Option<Vec<f64>> {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_plugin::conformance;

    #[test]
    fn conforms() {
        conformance::encoding(&mut MyPlugin::default(), 8).expect("conforms");
    }
}
