//! Scene files.

use crate::support::{Bench, seeone};
use crate::{HOOK, SCENE, SKILL, each_is_refused, refused};

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

#[test]
fn a_wrong_hook_is_told() {
    let bench = Bench::new();
    bench.copy(HOOK);
    let run = |bench: &Bench| {
        let [skill, scene, out] = [SKILL, HOOK, "out"].map(|name| bench.arg(name));
        seeone(["run", &skill, "--scene", &scene, "--out", &out])
    };
    let told = |case: &str, bench: &Bench, code: &str, cause: &str| {
        refused(case, bench, &run(bench), code, &["hook.toml:", cause]);
    };
    let shipped = bench.text(HOOK);
    for (case, start, line, code, cause) in [
        ("endless", "length_m", "length_m = 1.5", "C020", "length_m = 1.5"),
        ("no number", "length_m", "length_m = nan", "C003", "nan"),
        ("unknown key", "length_m", "lenght_m = 0.14", "C012", "did you mean \"length_m\"?"),
        ("slippery", "friction = 0.3", "friction = -0.1", "C020", "friction"),
        (
            "leaning",
            "pose = { xyz_m = [0.25, 0.55",
            "pose = { xyz_m = [0.25, 0.55, 0.28], quat_xyzw = [1.0, 0.0, 0.0, 0.0] }",
            "C022",
            "leans",
        ),
        (
            "in the drop zone",
            "pose = { xyz_m = [0.25, 0.55",
            "pose = { xyz_m = [0.25, 0.55, 0.28], quat_xyzw = [0.0, 0.0, 0.0, 1.0] }",
            "C023",
            "stands in the drop zone",
        ),
    ] {
        bench.write(HOOK, &shipped);
        bench.set_line(HOOK, start, line);
        told(case, &bench, code, cause);
    }
    let (before, rest) = shipped.split_once("[hook]").expect("a hook");
    let (hook, after) = rest.split_once("[camera]").expect("a camera");
    bench.write(HOOK, format!("{before}[camera]{after}"));
    told("neither head nor hook", &bench, "C011", "neither a [head] nor a [hook]");
    let place = "hook = { xyz_m = [0.0, 0.0, 0.0], quat_xyzw = [0.0, 0.0, 0.0, 1.0] }";
    bench.write(HOOK, format!("{before}[hook]{hook}[frames]\n{place}\n[camera]{after}"));
    told("a place named as a thing", &bench, "C021", "\"hook\"");
    bench.write(HOOK, &shipped);
    // The skill puts caps on a head.
    refused("no head", &bench, &run(&bench), "M005", &["\"head\"", "hook"]);
}
