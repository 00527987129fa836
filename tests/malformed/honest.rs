//! What could be tried and did not succeed is no error.

use crate::SCENE;
use crate::support::{Bench, Call};
use nalgebra::{Point3, Vector3};
use seeone_core::Cloud;
use seeone_core::formats::ply::{Encoding, read_cloud, write_cloud};

/// An attempt that could be made and did not succeed: exit status 1 and a reason.
fn failed_honestly(call: &Call, stage: &str, reason: &str) {
    assert_eq!(call.status, Some(1), "{}", call.stderr);
    let outcome: serde_json::Value = serde_json::from_str(&call.stdout).expect("JSON");
    assert_ne!(outcome["success"], true);
    let told = outcome["reason"].as_str().expect("a reason");
    assert!(told.starts_with(stage) && told.contains(reason), "{told}");
}

/// Moves a position by so many metres in x and y.
fn move_by(position: &mut toml::Value, metres: [f64; 2]) {
    for (axis, step) in metres.into_iter().enumerate() {
        let moved = position[axis].as_float().expect("a coordinate") + step;
        position[axis] = moved.into();
    }
}

#[test]
fn a_cap_out_of_reach_is_an_honest_failure() {
    let bench = Bench::new();
    bench.set_line(SCENE, "centre_xy_m", "centre_xy_m = [1.2, 0.0]");
    let encoding = ["--json", "--method", "encoding=nearest-feature"];
    failed_honestly(&bench.run(&encoding), "observe: ", "in sight");
    // The camera goes along with the drop zone, so that the cap is seen but out of reach.
    let bench = Bench::new();
    let mut scene: toml::Table = bench.text(SCENE).parse().expect("valid TOML");
    let along = [0.8, 0.2];
    move_by(&mut scene["drop"]["centre_xy_m"], along);
    move_by(&mut scene["camera"]["pose"]["xyz_m"], along);
    bench.write(SCENE, scene.to_string());
    failed_honestly(&bench.run(&encoding), "plan: ", "pick");
}

#[test]
fn an_empty_cloud_is_an_honest_failure() {
    let bench = Bench::new();
    bench.write(
        "scenes/empty.ply",
        "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n\
         property float z\nend_header\n",
    );
    bench.set_line(SCENE, "[camera]", "[camera]\ncloud = \"empty.ply\"");
    let words =
        ["--json", "--method", "camera=camera-file", "--method", "encoding=nearest-feature"];
    failed_honestly(&bench.run(&words), "observe: ", "in sight");
    bench.write("scenes/empty.ply", "");
    let damaged = bench.run(&["--method", "camera=camera-file"]);
    assert_eq!(damaged.status, Some(2), "{}", damaged.stderr);
    assert!(damaged.stderr.contains("empty.ply"), "{}", damaged.stderr);
}

/// A run that is shown `points` in the place of a cap.
fn shown(points: Vec<Point3<f64>>) -> Call {
    let bench = Bench::new();
    let cloud = Cloud::new(points).expect("finite points");
    write_cloud(&bench.path("scenes/seen.ply"), &cloud, Encoding::BinaryLittleEndian)
        .expect("written");
    bench.set_line(SCENE, "[camera]", "[camera]\ncloud = \"seen.ply\"");
    bench.run(&["--json", "--method", "camera=camera-file"])
}

/// A box of `size` metres in the drop zone, its faces towards the camera.
fn faces(size: [f64; 3]) -> Vec<Point3<f64>> {
    let steps = || (0..40).map(|i| f64::from(i) / 39.0);
    let grid = || steps().flat_map(|a| steps().map(move |b| (a, b)));
    let [length, width, height] = size;
    let at = |x: f64, y: f64, z: f64| {
        Point3::new(0.4 + (x - 0.5) * length, -0.2 + (y - 0.5) * width, z * height)
    };
    let top = grid().map(|(a, b)| at(a, b, 1.0));
    let front = grid().map(|(a, b)| at(a, 0.0, b));
    let side = grid().map(|(a, b)| at(1.0, a, b));
    top.chain(front).chain(side).collect()
}

#[test]
fn what_is_no_cap_and_what_is_two_are_left_alone() {
    for size in [[0.2, 0.15, 0.12], [0.2, 0.2, 0.2], [0.25, 0.18, 0.04], [0.06, 0.05, 0.04]] {
        failed_honestly(&shown(faces(size)), "perceive: ", "no object of the skill's category");
    }
    let cap = read_cloud(&Bench::new().path("skills/cap-wearing/demonstration.ply"));
    let cap = cap.expect("the shipped cloud");
    let beside = |point: &Point3<f64>| point + Vector3::new(0.16, 0.08, 0.0);
    let two = cap.points().iter().copied().chain(cap.points().iter().map(beside));
    failed_honestly(&shown(two.collect()), "perceive: ", "or more than one");
    // One is one.
    let one: serde_json::Value =
        serde_json::from_str(&shown(cap.points().to_vec()).stdout).expect("JSON");
    assert!(!one["reason"].as_str().expect("a reason").starts_with("perceive: "), "{one}");
    failed_honestly(&shown(cap.points()[..5].to_vec()), "perceive: ", "too few");
}
