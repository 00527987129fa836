//! Frames of a stored set, shown to the perception.

use nalgebra::Point3;
use seeone_core::Cloud;
use seeone_core::frames::Frame;
use seeone_plugin::Observation;

/// A frame of the set as a camera would have shown it.
pub fn observation(frame: &Frame) -> Observation {
    let points = frame.points.iter().map(|p| Point3::from(p.map(f64::from))).collect();
    Observation {
        depth: None,
        // The set was checked for finite points when it was read.
        cloud: Cloud::new(points).unwrap_or_default(),
        camera_position: Point3::from(frame.info.camera.xyz_m),
    }
}
