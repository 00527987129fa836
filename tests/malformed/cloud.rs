//! The cloud of a demonstration.

use crate::support::{Bench, seeone};
use crate::{SKILL, refused};

const CLOUD: &str = "skills/cap-wearing/demonstration.ply";

/// The demonstration's cloud, changed.
fn with_cloud(change: impl FnOnce(Vec<u8>, usize) -> Vec<u8>) -> Bench {
    let bench = Bench::new();
    let bytes = std::fs::read(bench.path(CLOUD)).expect("the cloud");
    let marker = b"end_header\n";
    let header = bytes.windows(marker.len()).position(|w| w == marker).expect("a header");
    bench.write(CLOUD, change(bytes, header + marker.len()));
    bench
}

#[test]
fn a_wrong_cloud_is_told() {
    let truncated = with_cloud(|mut bytes, _| {
        bytes.truncate(bytes.len() - 7);
        bytes
    });
    let not_finite = with_cloud(|mut bytes, body| {
        bytes[body..body + 8].copy_from_slice(&f64::NAN.to_le_bytes());
        bytes
    });
    let empty = with_cloud(|_, _| Vec::new());
    let boastful = with_cloud(|bytes, body| {
        let header = String::from_utf8_lossy(&bytes[..body]).into_owned();
        let count = header.lines().find(|l| l.starts_with("element vertex")).expect("a count");
        let mut boast = header.replace(count, "element vertex 4000000000").into_bytes();
        boast.extend_from_slice(&bytes[body..]);
        boast
    });
    let cases = [
        ("truncated", &truncated, "P003", "declares"),
        ("not finite", &not_finite, "P004", "point 0"),
        ("empty", &empty, "P002", "demonstration.ply"),
        ("boastful", &boastful, "P003", "4000000000"),
    ];
    for (case, bench, code, cause) in cases {
        refused(case, bench, &bench.run(&[]), code, &["demonstration.ply", cause]);
        let checked = seeone(["check", &bench.arg(CLOUD), &bench.arg(SKILL)]);
        assert_eq!(checked.status, Some(1), "{case}");
        assert_eq!(checked.stderr.matches(&format!("error[{code}]")).count(), 2, "{case}");
    }
}

#[test]
fn a_hand_that_closes_beside_its_cloud_is_told() {
    let bench = Bench::new();
    let mut skill: toml::Table = bench.text(SKILL).parse().expect("valid TOML");
    let place = &mut skill["stage"][0]["gripper_pose"]["xyz_m"][0];
    *place = (place.as_float().expect("a coordinate") + 0.3).into();
    bench.write(SKILL, skill.to_string());
    let says = ["demonstration.ply", "\"pick\"", "closes on no points", "mm away"];
    refused("beside", &bench, &bench.run(&[]), "M006", &says);
    let checked = seeone(["check", &bench.arg(SKILL)]);
    assert_eq!(checked.status, Some(1), "{}", checked.stderr);
    assert!(checked.stderr.contains("error[S032]: "), "{}", checked.stderr);
    assert!(checked.stderr.contains("cap-wearing.toml:"), "{}", checked.stderr);
}
