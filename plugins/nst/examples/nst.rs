//! The plugins of this crate as a dynamic library.

seeone_plugin::export_plugins! {
    Perception "nst" => seeone_nst::build,
    Perception "nst-one-pass" => seeone_nst::build_one_pass,
}
