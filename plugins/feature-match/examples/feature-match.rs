//! The plugin of this crate as a dynamic library.

seeone_plugin::export_plugins! {
    Transfer "feature-match" => seeone_feature_match::FeatureMatch::from_setup,
}
