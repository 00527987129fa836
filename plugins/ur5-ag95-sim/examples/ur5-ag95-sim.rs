//! The plugins of this crate as a dynamic library.

seeone_plugin::export_plugins! {
    Robot "ur5-ag95-sim" => seeone_ur5_ag95_sim::SimulatedArm::lagging,
    Robot "ideal-sim" => seeone_ur5_ag95_sim::SimulatedArm::ideal,
}
