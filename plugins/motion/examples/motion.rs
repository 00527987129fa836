//! The plugins of this crate as a dynamic library.

seeone_plugin::export_plugins! {
    Motion "motion" => seeone_motion::Planner::from_setup,
    Motion "joint-line" => seeone_motion::JointLine::from_setup,
}
