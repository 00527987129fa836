//! The plugins of this crate as a dynamic library.

seeone_plugin::export_plugins! {
    Alignment "procrustes" => seeone_procrustes::Procrustes::from_setup,
    Alignment "ransac" => seeone_procrustes::Ransac::from_setup,
}
