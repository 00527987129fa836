//! The plugins of this crate as a dynamic library.

seeone_plugin::export_plugins! {
    Camera "camera-sim" => seeone_camera_sim::SimulatedCamera::from_setup,
    Camera "camera-file" => seeone_camera_sim::RecordedCamera::from_setup,
}
