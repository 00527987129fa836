//! `check`, of many files at once.

use crate::support::{Bench, seeone};
use crate::{ROBOT, SCENE, SKILL};

#[test]
fn check_tells_the_faults_of_every_file() {
    let bench = Bench::new();
    let (skill, scene, robot) = (bench.arg(SKILL), bench.arg(SCENE), bench.arg(ROBOT));
    let sound = seeone(["check", &skill, &scene, &robot, "plugins/nst/weights/coarse.safetensors"]);
    assert_eq!(sound.status, Some(0), "{}", sound.stderr);
    let places = [
        bench.set_line(SKILL, "lift_m", "lift_m = 99.0"),
        bench.set_line(SCENE, "size", "semi_axes_m = [0.1, 0.1]"),
        bench.set_line(ROBOT, "urdf", "urdf = 3"),
    ];
    let files = [&skill, &scene, &robot];
    let told = seeone(["check", &skill, &scene, &robot, "none.toml"]);
    assert_eq!((told.status, told.stdout.as_str()), (Some(1), ""));
    for ((file, line), code) in files.iter().zip(places).zip(["S020", "C013", "B013"]) {
        let place = format!("error[{code}]: {file}:{line}:");
        assert!(told.stderr.contains(&place), "{place} is not in {}", told.stderr);
    }
    assert!(told.stderr.contains("none.toml"), "{}", told.stderr);
    let json = seeone(["check", "--json", &skill, &scene, &robot]);
    assert_eq!((json.status, json.stderr.as_str()), (Some(1), ""));
    let rows: serde_json::Value = serde_json::from_str(&json.stdout).expect("JSON");
    let rows = rows.as_array().expect("an array");
    assert_eq!(rows.len(), 3);
    for (row, (file, line)) in rows.iter().zip(files.iter().zip(places)) {
        assert_eq!((&row["file"], &row["line"]), (&(**file).clone().into(), &line.into()));
        for key in ["code", "cause", "hint"] {
            assert!(row[key].is_string(), "{key} of {row}");
        }
        assert!(row["column"].is_u64(), "{row}");
    }
    let none = seeone(["check", "--json", "plugins/nst/weights/coarse.safetensors"]);
    assert_eq!((none.status, none.stdout.trim()), (Some(0), "[]"));
}
