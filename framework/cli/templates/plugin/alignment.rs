//! `my-plugin`, a plugin of kind `alignment`: the similarity of least weighted squares.

use seeone_core::Similarity;
use seeone_core::similarity_fit::weighted_similarity;
use seeone_plugin::{Alignment, AlignmentOutcome, Correspondences, PluginError, Setup};
use serde::Deserialize;

seeone_plugin::export_plugins! {
    Alignment "my-plugin" => MyPlugin::from_setup,
}

/// Aligns pairs of points. Its fields are its table in a robot file, `[config.alignment]`.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MyPlugin {
    /// Sources that spread over less than this share of their longest extent do not determine
    /// a rotation.
    least_spread: f64,
}

impl Default for MyPlugin {
    fn default() -> Self {
        Self { least_spread: 1e-6 }
    }
}

impl MyPlugin {
    /// From its table.
    ///
    /// # Errors
    /// [`PluginError::Configuration`] for an unknown key or a number out of range.
    pub fn from_setup(setup: &Setup) -> Result<Self, PluginError> {
        let plugin: Self = setup.configuration()?;
        if !(0.0..1.0).contains(&plugin.least_spread) {
            let told = format!("least_spread is {}, not from 0 to 1", plugin.least_spread);
            return Err(PluginError::Configuration(told));
        }
        Ok(plugin)
    }
}

impl Alignment for MyPlugin {
    fn align(&self, pairs: &Correspondences) -> Result<AlignmentOutcome, PluginError> {
        pairs.check()?;
        let refuse = |why: &str| PluginError::Input(why.to_owned());
        let fitted = weighted_similarity(pairs.source, pairs.target, pairs.weights)
            .ok_or_else(|| refuse("the pairs determine no similarity"))?;

        let total: f64 = pairs.weights.iter().sum();
        let mean = |points: &[nalgebra::Point3<f64>]| {
            let sum: nalgebra::Vector3<f64> =
                points.iter().zip(pairs.weights).map(|(p, w)| p.coords * *w).sum();
            sum / total
        };
        let (from, to) = (mean(pairs.source), mean(pairs.target));
        let mut scatter = nalgebra::Matrix3::zeros();
        for (point, weight) in pairs.source.iter().zip(pairs.weights) {
            let offset = point.coords - from;
            scatter += offset * offset.transpose() * *weight;
        }
        let mut extents: [f64; 3] = scatter.symmetric_eigenvalues().into();
        extents.sort_by(f64::total_cmp);
        let condition = (extents[1].max(0.0) / extents[2]).sqrt().clamp(0.0, 1.0);
        if condition <= self.least_spread {
            return Err(refuse("the points lie on one line"));
        }

        let scale = pairs.fixed_scale.unwrap_or(fitted.scaling());
        let rotation = fitted.isometry.rotation;
        let shift = to - rotation * from * scale;
        let transform = Similarity::from_parts(shift.into(), rotation, scale);
        let squares: f64 = (pairs.source.iter().zip(pairs.target).zip(pairs.weights))
            .map(|((s, t), w)| w * (transform * s - t).norm_squared())
            .sum();
        let residual = (squares / total).sqrt();
        Ok(AlignmentOutcome { transform, residual, inlier_share: 1.0, condition })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_plugin::conformance;

    #[test]
    fn conforms() {
        conformance::alignment(&MyPlugin::default()).expect("conforms");
    }
}
