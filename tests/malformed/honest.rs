//! What could be tried and did not succeed is no error.

use crate::SCENE;
use crate::support::{Bench, Call};

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
