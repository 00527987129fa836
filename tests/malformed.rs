//! What is given wrong is told with code, place and advice; nothing is left half-written,
//! nothing panics, and what is merely out of reach ends in an honest "no".

mod support;

use support::{Bench, Call, seeone};

const SKILL: &str = "skills/cap-wearing.toml";
const CLOUD: &str = "skills/cap-wearing/demonstration.ply";
const SCENE: &str = "scenes/head.toml";
const ROBOT: &str = "robots/ur5-ag95-sim.toml";
const URDF: &str = "robots/ur5-ag95.urdf";

/// A call that was refused: exit status 2, a code, every word of `says`, advice, and
/// neither data nor files.
fn refused(case: &str, bench: &Bench, call: &Call, code: &str, says: &[&str]) {
    assert_eq!(call.status, Some(2), "{case}: {}", call.stderr);
    assert!(call.stderr.contains(&format!("error[{code}]: ")), "{case}: {}", call.stderr);
    for word in says.iter().chain(&["hint: "]) {
        assert!(call.stderr.contains(word), "{case}: {word:?} is not in: {}", call.stderr);
    }
    assert_eq!(call.stdout, "", "{case}");
    assert_eq!(bench.listing("out"), [""; 0], "{case}");
}

/// A change of one shipped file that makes it wrong.
type Change<'a> = (&'a str, &'a str, &'a str, &'a str, &'a str);

/// Runs with each change in turn: (case, start of the line, what replaces it, code, cause).
/// The place must be the changed line.
fn each_is_refused(file: &str, changes: &[Change]) {
    for (case, start, line, code, cause) in changes {
        let bench = Bench::new();
        let number = bench.set_line(file, start, line);
        let place = format!("{}:{number}:", bench.arg(file));
        refused(case, &bench, &bench.run(&[]), code, &[&place, cause]);
    }
}

#[test]
fn a_wrong_line_of_a_skill_is_told() {
    each_is_refused(
        SKILL,
        &[
            ("syntax", "name", "name = cap wearing", "S002", ""),
            ("unknown key", "lift_m", "lift_mm = 3.0", "S012", "did you mean \"lift_m\"?"),
            ("not finite", "lift_m", "lift_m = nan", "S003", "nan is not a finite number"),
            ("wrong type", "lift_m", "lift_m = \"high\"", "S013", ""),
            ("too far", "approach_m", "approach_m = 7.0", "S020", "approach_m"),
            (
                "not a rotation",
                "gripper_pose",
                "gripper_pose = { xyz_m = [0.4, -0.2, 0.1], quat_xyzw = [0.0, 0.0, 0.0, 2.0] }",
                "S022",
                "gripper_pose",
            ),
            ("missing cloud", "cloud", "cloud = \"cap-wearing/none.ply\"", "S024", "none.ply"),
            ("cloud elsewhere", "cloud", "cloud = \"../secret.ply\"", "S024", "own folder"),
            ("unknown method", "transfer", "transfer = \"feature-mach\"", "S024", "feature-match"),
            (
                "unknown kind",
                "transfer",
                "transfers = \"snap\"",
                "S012",
                "did you mean \"transfer\"?",
            ),
            ("unknown measure", "measure", "measure = \"won\"", "S024", "did you mean \"worn\"?"),
            (
                "unknown frame",
                "relative_to = \"head\"",
                "relative_to = \"hed\"",
                "S024",
                "\"head\"?",
            ),
            ("wrong schema", "schema", "schema = 2", "S010", "schema = 1"),
        ],
    );
}

#[test]
fn a_skill_that_is_no_skill_is_told() {
    let cases: [(&str, Vec<u8>, &str, &str); 4] = [
        ("too large", vec![b'#'; (1 << 20) + 1], "S001", "1048577 bytes"),
        ("not text", vec![0xff, 0xfe, 0x00], "S001", "not UTF-8"),
        ("empty", Vec::new(), "S010", "schema"),
        ("nothing but a schema", b"schema = 1\n".to_vec(), "S011", "missing"),
    ];
    for (case, bytes, code, cause) in cases {
        let bench = Bench::new();
        bench.write(SKILL, bytes);
        refused(case, &bench, &bench.run(&[]), code, &[&bench.arg(SKILL), cause]);
    }
    let bench = Bench::new();
    let stages = bench.text(SKILL);
    let (head, rest) = stages.split_once("[[stage]]").expect("stages");
    let (_, tail) = rest.split_once("[methods]").expect("methods");
    bench.write(SKILL, format!("{head}[methods]{tail}"));
    refused("no stages", &bench, &bench.run(&[]), "S023", &["no [[stage]]"]);
    let missing = seeone(["run", "skills/none.toml", "--out", &bench.arg("out")]);
    refused("missing", &bench, &missing, "S001", &["skills/none.toml"]);
    let folder = seeone(["run", "skills", "--out", &bench.arg("out")]);
    refused("a folder", &bench, &folder, "S001", &["skills"]);
}

#[test]
fn every_fault_of_a_file_is_told_at_once() {
    let bench = Bench::new();
    let first = bench.set_line(SKILL, "approach_m", "approach_m = 7.0");
    let last = bench.set_line(SKILL, "measure", "measure = \"hung\"");
    let places = [first, last].map(|line| format!("{}:{line}:", bench.arg(SKILL)));
    refused(
        "two faults",
        &bench,
        &bench.run(&[]),
        "S020",
        &[&places[0], "error[S024]", &places[1]],
    );
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
fn a_wrong_scene_is_told() {
    each_is_refused(
        SCENE,
        &[
            ("syntax", "name", "name = \"head", "C002", ""),
            ("unknown key", "friction", "fiction = 0.6", "C012", "did you mean \"friction\"?"),
            ("flat head", "semi_axes_m", "semi_axes_m = [0.0, 0.1, 0.1]", "C020", "semi_axes_m"),
            (
                "no pixels",
                "intrinsics",
                "intrinsics = { width = 0, height = 480, fx = 384.0, fy = 384.0, cx = 1.0, cy = 1.0 }",
                "C020",
                "0 x 480",
            ),
            ("infinite", "crop_height_m", "crop_height_m = inf", "C003", "inf"),
            ("negative drop", "height_m = 0.12", "height_m = -1.0", "C020", "height_m"),
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
fn a_wrong_robot_is_told() {
    each_is_refused(
        ROBOT,
        &[
            ("syntax", "plugin", "plugin = ", "B002", ""),
            ("unknown plugin", "plugin", "plugin = \"ur5-sim\"", "B024", "ur5-ag95-sim"),
            ("missing URDF", "urdf", "urdf = \"none.urdf\"", "B024", "none.urdf"),
            ("no acceleration", "acceleration_rad_s2", "acceleration_rad_s2 = 0.0", "B020", ""),
            ("unknown kind", "[limits]", "[config.magic]\na = 1\n[limits]", "B012", "magic"),
        ],
    );
    let changes: [(&str, &str, &str, &str, &str); 5] = [
        ("no URDF", "<robot", "<rowboat", "R002", "ur5-ag95.urdf"),
        ("lower above upper", "lower=\"-6.28", "lower=\"66.28", "R002", "upper position limit"),
        ("not finite", "lower=\"-6.28", "lower=\"NaN\" was=\"", "R006", "ur5-ag95.urdf"),
        ("unknown link", "child link=\"", "child link=\"no_", "R004", "ur5-ag95.urdf"),
        ("cut short", "</robot>", "", "R002", "ur5-ag95.urdf"),
    ];
    for (case, from, to, code, cause) in changes {
        let bench = Bench::new();
        let text = bench.text(URDF);
        assert!(text.contains(from), "{case}");
        bench.write(URDF, text.replacen(from, to, 1));
        refused(case, &bench, &bench.run(&[]), code, &[cause]);
    }
    for (case, line, code) in [
        ("home of two joints", "home_rad = [0.0, 1.0]", "R0"),
        ("home out of the limits", "home_rad = [0.0, 0.0, 9.0, 0.0, 0.0, 0.0]", "R0"),
        ("unknown tool", "tool_link = \"tpc\"", "R0"),
    ] {
        let bench = Bench::new();
        bench.set_line(ROBOT, &line[..8], line);
        let call = bench.run(&[]);
        assert_eq!(call.status, Some(2), "{case}: {}", call.stderr);
        assert!(call.stderr.contains(&format!("error[{code}")), "{case}: {}", call.stderr);
        assert!(call.stderr.contains("hint: "), "{case}: {}", call.stderr);
    }
    let bench = Bench::new();
    let skill = bench.arg(SKILL);
    let missing =
        seeone(["run", &skill, "--robot", "robots/none.toml", "--out", &bench.arg("out")]);
    refused("missing", &bench, &missing, "B001", &["robots/none.toml"]);
}

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
fn a_wrong_flag_is_told() {
    let bench = Bench::new();
    let unknown = bench.run(&["--method", "transfer=nonsense"]);
    refused("plugin", &bench, &unknown, "M001", &["\"nonsense\"", "feature-match"]);
    let object = bench.run(&["--object", "cap-unseen-1"]);
    refused("object", &bench, &object, "O001", &["did you mean \"cap-unseen-"]);
    let file = bench.run(&["--object", "none.toml"]);
    refused("object file", &bench, &file, "O004", &["none.toml"]);
    for (words, says) in [
        (vec!["--method", "nonsense=x"], "perception"),
        (vec!["--method", "transfer"], "KIND=PLUGIN"),
        (vec!["--seed", "one"], "--seed"),
        (vec!["--nonsense"], "--nonsense"),
    ] {
        let call = bench.run(&words);
        assert_eq!(call.status, Some(2), "{words:?}: {}", call.stderr);
        assert!(call.stderr.contains(says), "{words:?}: {}", call.stderr);
        assert_eq!(bench.listing("out"), [""; 0]);
    }
    bench.write("out", "a file where a folder is wanted");
    let out = bench.run(&[]);
    assert_eq!(out.status, Some(2), "{}", out.stderr);
    assert!(out.stderr.contains("error[F002]: ") && out.stderr.contains("--out"), "{}", out.stderr);
}

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

#[test]
fn an_untrusted_or_damaged_library_is_refused() {
    let bench = Bench::new();
    let library = bench.arg("libmine.so");
    let plugin = |bench: &Bench| bench.run(&["--plugin", &library]);
    refused("missing", &bench, &plugin(&bench), "P001", &["libmine.so"]);
    bench.write("libmine.so", [0x7f, b'E', b'L', b'F', 0, 0]);
    refused("no manifest", &bench, &plugin(&bench), "P001", &["plugins trust"]);
    let trusted = seeone(["plugins", "trust", &library]);
    refused("no library to trust", &bench, &trusted, "P005", &["libmine.so"]);
    let manifest = |size: usize, hash: &str| {
        format!(
            "schema = 1\nname = \"mine\"\nkind = \"alignment\"\nversion = \"1\"\nabi = [1, 0]\n\
             size_bytes = {size}\nblake3 = \"{hash}\"\n"
        )
    };
    bench.write("libmine.so.toml", manifest(600, &"0".repeat(64)));
    refused("truncated", &bench, &plugin(&bench), "P003", &["600"]);
    bench.write("libmine.so.toml", manifest(6, &"0".repeat(64)));
    refused("changed", &bench, &plugin(&bench), "P004", &["plugins trust"]);
    bench.write("libmine.so.toml", "schema = ");
    refused("damaged manifest", &bench, &plugin(&bench), "P002", &["libmine.so.toml:1:"]);
}

#[test]
fn missing_or_damaged_weights_are_told() {
    let bench = Bench::new();
    let weights = bench.arg("weights");
    bench.append(ROBOT, &format!("\n[config.perception]\nweights = \"{weights}\"\n"));
    refused("no folder", &bench, &bench.run(&[]), "M002", &["perception", "card.toml"]);
    std::fs::create_dir(bench.path("weights")).expect("a folder");
    let shipped = support::root().join("plugins/nst/weights");
    std::fs::copy(shipped.join("card.toml"), bench.path("weights/card.toml")).expect("a card");
    refused("no weights", &bench, &bench.run(&[]), "M002", &["coarse.safetensors"]);
    for name in ["coarse", "refiner"] {
        let file = format!("{name}.safetensors");
        let bytes = std::fs::read(shipped.join(&file)).expect("shipped weights");
        bench.write(&format!("weights/{file}"), &bytes[..bytes.len() / 2]);
    }
    refused("truncated", &bench, &bench.run(&[]), "M002", &["coarse.safetensors"]);
    let checked = seeone(["check", &bench.arg("weights/coarse.safetensors")]);
    assert_eq!(checked.status, Some(1), "{}", checked.stderr);
    bench.write("weights/card.toml", "schema = 1\nnetwork = ");
    refused("damaged card", &bench, &bench.run(&[]), "M002", &["card.toml:2:"]);
    let robot = bench.text(ROBOT).replace("weights = ", "wieghts = ");
    bench.write(ROBOT, robot);
    refused("unknown key", &bench, &bench.run(&[]), "M002", &["wieghts"]);
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

#[test]
fn check_tells_the_faults_of_every_file() {
    let bench = Bench::new();
    let (skill, scene, robot) = (bench.arg(SKILL), bench.arg(SCENE), bench.arg(ROBOT));
    let sound = seeone(["check", &skill, &scene, &robot, "plugins/nst/weights/coarse.safetensors"]);
    assert_eq!(sound.status, Some(0), "{}", sound.stderr);
    let places = [
        bench.set_line(SKILL, "lift_m", "lift_m = 99.0"),
        bench.set_line(SCENE, "semi_axes_m", "semi_axes_m = [0.1, 0.1]"),
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

/// An attempt that could be made and did not succeed: exit status 1 and a reason.
fn failed_honestly(call: &Call, stage: &str, reason: &str) {
    assert_eq!(call.status, Some(1), "{}", call.stderr);
    let outcome: serde_json::Value = serde_json::from_str(&call.stdout).expect("JSON");
    assert_ne!(outcome["success"], true);
    let told = outcome["reason"].as_str().expect("a reason");
    assert!(told.starts_with(stage) && told.contains(reason), "{told}");
}

#[test]
fn a_cap_out_of_reach_is_an_honest_failure() {
    let bench = Bench::new();
    bench.set_line(SCENE, "centre_xy_m", "centre_xy_m = [1.2, 0.0]");
    let encoding = ["--json", "--method", "encoding=nearest-feature"];
    failed_honestly(&bench.run(&encoding), "observe: ", "in sight");
    let scene = bench.text(SCENE);
    let (_, camera) = scene.split_once("[camera]").expect("a camera");
    let pose = camera.lines().find(|line| line.starts_with("pose = ")).expect("its pose");
    let (_, turn) = pose.split_once("quat_xyzw").expect("its rotation");
    // The camera goes along with the drop zone, so that the cap is seen but out of reach.
    let along = format!("pose = {{ xyz_m = [1.6346, -0.2509, 0.5874], quat_xyzw{turn}");
    bench.write(SCENE, scene.replace(pose, &along));
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
