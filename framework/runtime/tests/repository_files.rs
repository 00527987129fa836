//! The files that come with the project are sound.

use nalgebra::{Point3, Vector3};
use seeone_runtime::{KnownMethods, RobotFile, Scene, check};
use std::fs;
use std::path::{Path, PathBuf};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[test]
fn every_skill_task_scene_and_robot_passes_the_check() {
    let mut checked = 0;
    for folder in ["skills", "skills/tasks", "scenes", "robots"] {
        for entry in fs::read_dir(repository().join(folder)).expect("the folder is there") {
            let path = entry.expect("an entry").path();
            if path.extension().is_some_and(|extension| extension == "toml") {
                assert_eq!(check(&path, &KnownMethods::new()), [], "{}", path.display());
                checked += 1;
            }
        }
    }
    assert!(checked >= 4, "{checked} files");
}

#[test]
fn the_camera_sees_caps_in_the_drop_zone_and_on_the_head_whole() {
    let scene =
        Scene::read(&repository().join("scenes/head.toml"), &KnownMethods::new()).expect("a scene");
    let dropped = Point3::new(scene.drop.centre.x, scene.drop.centre.y, 0.05);
    let head = scene.head().expect("a head").pose.translation.vector;
    let worn = Point3::from(head + Vector3::z() * 0.05);
    // A cap reaches 0.16 m from its middle.
    for (middle, far) in [(dropped, 0.8), (worn, 1.1)] {
        for side in [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| axis * 0.16) {
            for point in [middle + side, middle - side] {
                let seen = scene.camera.inverse_transform_point(&point);
                let (u, v, depth) = scene.intrinsics.project(&seen).expect("in front");
                assert!((0.0..640.0).contains(&u) && (0.0..480.0).contains(&v), "{point}: {u} {v}");
                assert!((0.4..far).contains(&depth), "{point}: {depth}");
            }
        }
    }
    let down = scene.camera * Vector3::y();
    assert!(down.z < 0.0, "the image is upright");
}

#[test]
fn the_robot_waits_above_the_mat_with_its_hand_down() {
    let path = repository().join("robots/ur5-ag95-sim.toml");
    let robot = RobotFile::read(&path, &KnownMethods::new()).expect("a robot file");
    let model = robot.model().expect("a robot");
    let tool = model.tool_pose(model.home());
    assert!(tool.translation.z > 0.25, "{}", tool.translation);
    assert!((tool.rotation * Vector3::z() + Vector3::z()).norm() < 1e-3);
}
