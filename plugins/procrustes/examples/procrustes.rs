//! The plugin `procrustes` as a dynamic library.

seeone_plugin::export_alignment!("procrustes", seeone_procrustes::Procrustes::from_setup);
