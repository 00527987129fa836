//! The encodings as plugins.

use crate::{NearestFeature, Nse, NseError};
use seeone_plugin::{PluginError, Setup};
use serde::Deserialize;
use std::path::PathBuf;

/// The table of the plugin `nse`.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct NseConfig {
    /// Folder of the weights and their card, relative to the plugin's root.
    pub weights: PathBuf,
    /// Folder of the weights of the perception that it works behind, likewise.
    pub perception_weights: PathBuf,
}

impl Default for NseConfig {
    fn default() -> Self {
        Self {
            weights: "plugins/nse/weights".into(),
            perception_weights: "plugins/nst/weights".into(),
        }
    }
}

/// Builds the plugin `nse` from its table.
///
/// # Errors
/// [`PluginError::Configuration`] for a wrong table, [`PluginError::Resource`] when the
/// weights cannot be used or belong behind another perception.
pub fn build(setup: &Setup<'_>) -> Result<Nse, PluginError> {
    let config: NseConfig = setup.configuration()?;
    let folder = |path: PathBuf| setup.root.join(path);
    Nse::load(&folder(config.weights), &folder(config.perception_weights)).map_err(NseError::into)
}

/// The table of the plugin `nearest-feature`: it has nothing to choose.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NearestFeatureConfig {}

/// Builds the plugin `nearest-feature` from its table.
///
/// # Errors
/// [`PluginError::Configuration`] when the table holds anything.
pub fn build_nearest_feature(setup: &Setup<'_>) -> Result<NearestFeature, PluginError> {
    let NearestFeatureConfig {} = setup.configuration()?;
    Ok(NearestFeature)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_table_or_missing_weights_are_told_apart() {
        let folder = tempfile::tempdir().expect("a folder");
        let told = |text: &str| {
            let config: toml::Table = toml::from_str(text).expect("TOML");
            let setup =
                Setup { config: &config, root: folder.path(), seed: 0, robot: None, world: None };
            (build(&setup).err(), build_nearest_feature(&setup).err())
        };
        let (nse, nearest) = told("weigths = \"a\"");
        assert!(matches!(nse, Some(PluginError::Configuration(_))), "{nse:?}");
        assert!(matches!(nearest, Some(PluginError::Configuration(_))), "{nearest:?}");
        let (nse, nearest) = told("");
        assert!(matches!(nse, Some(PluginError::Resource(_))), "{nse:?}");
        assert!(nearest.is_none());
    }
}
