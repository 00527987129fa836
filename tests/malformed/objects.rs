//! Object files, and meshes that shall become objects.

use crate::refused;
use crate::support::{Bench, seeone};

#[test]
fn a_wrong_object_file_is_told() {
    let material = "{ density_kg_m2 = 0.5, bending_n_m = 1e-4, thickness_m = 0.001 }";
    let object = |regions: &str, triangle: &str, x: &str| {
        format!(
            "schema = 1\nname = \"a\"\ncategory = \"cap\"\nsoftness_hz = 5.0\nregions = \"{regions}\"\n\
             vertices_m = [[{x}, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.1, 0.0]]\n\
             triangles = [{triangle}]\ncrown = {material}\nfront = {material}\n\
             brim = {material}\nhem = {material}\n"
        )
    };
    for (case, text) in [
        ("empty", String::new()),
        ("syntax", "vertices_m = [".into()),
        ("unknown key", object("c", "[0, 1, 2]", "0.0") + "colour = 3\n"),
        ("schema", object("c", "[0, 1, 2]", "0.0").replace("schema = 1", "schema = 9")),
        ("region", object("q", "[0, 1, 2]", "0.0")),
        ("too many regions", object("cc", "[0, 1, 2]", "0.0")),
        ("missing vertex", object("c", "[0, 1, 7]", "0.0")),
        ("not finite", object("c", "[0, 1, 2]", "nan")),
        ("no triangle", object("", "", "0.0")),
        ("no weight", object("c", "[0, 1, 2]", "0.0").replace("= 0.5,", "= 0.0,")),
        ("too large", object("c", "[0, 1, 2]", "0.0") + &"#".repeat(1 << 20)),
    ] {
        let bench = Bench::new();
        bench.write("a.toml", text);
        let call = bench.run(&["--object", &bench.arg("a.toml")]);
        refused(case, &bench, &call, "O004", &["a.toml"]);
    }
}

/// A box whose edges are 1.
fn cube() -> String {
    let mut text = String::new();
    for corner in 0..8 {
        let bit = |axis: u32| (corner >> axis) & 1;
        text += &format!("v {} {} {}\n", bit(0), bit(1), bit(2));
    }
    for face in ["1 2 4 3", "5 6 8 7", "1 2 6 5", "3 4 8 7", "1 3 7 5", "2 4 8 6"] {
        text += &format!("f {face}\n");
    }
    text
}

#[test]
fn a_mesh_that_makes_no_cap_is_told() {
    let plain = ["--up", "+y", "--front", "+z", "--head-circumference", "0.57"];
    let with = |index: usize, value: &'static str| {
        let mut words = plain;
        words[index] = value;
        words
    };
    let triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let cases = [
        ("no faces", triangle.to_owned(), plain, "O003", "no faces"),
        ("empty", String::new(), plain, "O003", "a.obj"),
        ("not finite", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".into(), plain, "O003", "finite"),
        ("no vertex", format!("{triangle}f 1 2 9\n"), plain, "O003", "a.obj"),
        (
            "a million",
            triangle.to_owned() + &"f 1 2 3\n".repeat(1_000_000),
            plain,
            "O003",
            "1000000",
        ),
        ("a cube", cube(), plain, "O003", "cap"),
        ("not an OBJ", "\u{0}\u{1}f x y z\n".into(), plain, "O003", "a.obj"),
        ("unknown axis", cube(), with(1, "up"), "O002", "--up"),
        ("front is up", cube(), with(3, "-y"), "O003", "front"),
        ("giant", cube(), with(5, "57"), "O003", "--head-circumference"),
        ("no size", cube(), with(5, "nan"), "O003", "--head-circumference"),
    ];
    for (case, mesh, options, code, cause) in cases {
        let bench = Bench::new();
        bench.write("a.obj", mesh);
        let (mesh, out) = (bench.arg("a.obj"), bench.arg("a.toml"));
        let mut words = vec!["objects", "import", &mesh, "--out", &out];
        words.extend(options);
        refused(case, &bench, &seeone(&words), code, &[cause]);
        assert!(!bench.path("a.toml").exists(), "{case}");
        words[2] = "none.obj";
        if case == "a cube" {
            refused("missing", &bench, &seeone(&words), "O003", &["none.obj"]);
        }
    }
}
