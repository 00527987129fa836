//! Scene files.

use crate::support::{Bench, seeone};
use crate::{SCENE, SKILL, each_is_refused, refused};

#[test]
fn a_wrong_scene_is_told() {
    each_is_refused(
        SCENE,
        &[
            ("syntax", "name", "name = \"head", "C002", ""),
            ("unknown key", "friction", "fiction = 0.6", "C012", "did you mean \"friction\"?"),
            ("flat head", "size", "semi_axes_m = [0.0, 0.1, 0.1]", "C020", "semi_axes_m"),
            (
                "no pixels",
                "intrinsics",
                "intrinsics = { width = 0, height = 480, fx = 384.0, fy = 384.0, cx = 1.0, cy = 1.0 }",
                "C020",
                "0 x 480",
            ),
            ("infinite", "crop_height_m", "crop_height_m = inf", "C003", "inf"),
            (
                "negative crop",
                "crop_height_m = 0.30",
                "crop_height_m = -1.0",
                "C020",
                "crop_height_m",
            ),
        ],
    );
    let bench = Bench::new();
    let skill = bench.arg(SKILL);
    let missing =
        seeone(["run", &skill, "--scene", "scenes/none.toml", "--out", &bench.arg("out")]);
    refused("missing", &bench, &missing, "C001", &["scenes/none.toml"]);
    let empty = bench.text(SCENE).replace("object = \"unseen\"", "object = \"hat\"");
    bench.write(SCENE, empty);
    refused("unknown object", &bench, &bench.run(&[]), "O001", &["\"hat\""]);
}

#[test]
fn an_unclosed_bracket_is_not_told_for_every_line_after_it() {
    let bench = Bench::new();
    bench.set_line(SCENE, "name", "name = [");
    let call = bench.run(&[]);
    refused("unclosed", &bench, &call, "C002", &["head.toml:", "more; `seeone check` tells all"]);
    assert_eq!(call.stderr.matches("error[").count(), 5, "{}", call.stderr);
}

#[test]
fn a_wrong_obstacle_is_told() {
    let pose = "pose = { xyz_m = [0.9, -0.5, 0.4], quat_xyzw = [0.0, 0.0, 0.0, 1.0] }";
    for (case, shape, code, cause) in [
        ("no shape", "", "C011", "either size_m"),
        ("two shapes", "size_m = [0.1, 0.1, 0.1]\nradius_m = 0.1", "C011", "either size_m"),
        ("no length", "radius_m = 0.1", "C011", "either size_m"),
        ("flat", "size_m = [0.1, 0.0, 0.1]", "C020", "size_m"),
        ("unknown key", "mass_kg = 1.0", "C012", "mass_kg"),
    ] {
        let bench = Bench::new();
        bench.append(SCENE, &format!("\n[[obstacle]]\nname = \"stand\"\n{pose}\n{shape}\n"));
        refused(case, &bench, &bench.run(&[]), code, &["head.toml:", cause]);
    }
}
