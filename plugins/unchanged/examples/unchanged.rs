//! The plugins of this crate as a dynamic library.

seeone_plugin::export_plugins! {
    Transfer "snap" => seeone_unchanged::Snap::from_setup,
    Transfer "unchanged" => seeone_unchanged::Unchanged::from_setup,
}
