//! The plugins of this crate as a dynamic library.

seeone_plugin::export_plugins! {
    Encoding "nse" => seeone_nse::build,
    Encoding "nearest-feature" => seeone_nse::build_nearest_feature,
}
