//! Files of targets that are wrong, and robots that `ik` cannot ask.

use crate::refused;
use crate::support::{Bench, Call, seeone};

/// Asks for the flange at poses of this text, the answers to go into the bench's `out`.
fn ask(bench: &Bench, text: &str, extra: &[&str]) -> Call {
    bench.write("T.json", text);
    let (robot, targets, out) =
        (bench.arg("robots/ur5-ag95-sim.toml"), bench.arg("T.json"), bench.arg("out"));
    let words = ["ik", "--robot", &robot, "--targets", &targets, "--out", &out];
    seeone(words.into_iter().chain(extra.iter().copied()))
}

/// A pose written with these three rows above the last.
fn with_rows(rows: &str) -> String {
    format!("[{{\"id\": 7, \"pose\": [{rows}, [0, 0, 0, 1]]}}]")
}

#[test]
fn a_wrong_file_of_targets_is_told_with_the_target_and_nothing_is_written() {
    let good = "[1, 0, 0, 0.4], [0, 1, 0, 0.1], [0, 0, 1, 0.4]";
    let cases = [
        ("no JSON", "[{\"id\": 0,,}]".to_owned(), "I002", "T.json:1:11: "),
        ("NaN", with_rows(&good.replace("0.4]", "NaN]")), "I003", "NaN is not a finite number"),
        ("infinite", with_rows(&good.replace("0.1]", "-Infinity]")), "I003", "Infinity is not"),
        ("too large", with_rows(&good.replace("0.1]", "1e999]")), "I003", "too large"),
        ("no array", "{\"id\": 0}".to_owned(), "I004", "not an array of targets"),
        ("no pose", "[{\"id\": 3}]".to_owned(), "I004", "target 0 (id 3): the key \"pose\""),
        ("no id", format!("[{{\"pose\": [{good}]}}]"), "I004", "target 0: the key \"id\""),
        ("three rows", format!("[{{\"id\": 7, \"pose\": [{good}]}}]"), "I004", "(id 7): pose"),
        ("a text", with_rows(&good.replace("0.4]", "\"x\"]")), "I004", "4x4 matrix of numbers"),
        ("scaled", with_rows(&good.replace("[1, 0, 0, ", "[1.1, 0, 0, ")), "I005", "orthonormal"),
        ("sheared", with_rows(&good.replace("[1, 0, 0, ", "[1, 0.1, 0, ")), "I005", "orthonormal"),
        ("mirrored", with_rows(&good.replace("[1, 0, 0, ", "[-1, 0, 0, ")), "I005", "reflection"),
        ("huge", with_rows(&good.replace("[1, 0, 0, ", "[1e200, 0, 0, ")), "I005", "(id 7)"),
        ("projective", with_rows(good).replace("[0, 0, 0, 1]", "[0, 0, 1, 1]"), "I005", "last row"),
    ];
    for (case, text, code, cause) in cases {
        let bench = Bench::new();
        let call = ask(&bench, &text, &[]);
        refused(case, &bench, &call, code, &["T.json", cause]);
        assert!(!bench.path("out").exists(), "{case}");
    }
    let bench = Bench::new();
    let path = format!("[{{\"id\": 7, \"poses\": [[{good}, [0, 0, 0, 1]], [[1]]]}}]");
    refused("path", &bench, &ask(&bench, &path, &["--path"]), "I004", &["poses[1]"]);
    let none = ask(&bench, "[{\"id\": 7, \"poses\": []}]", &["--path"]);
    refused("empty path", &bench, &none, "I004", &["at least one pose"]);
    let both = with_rows(&good.replace("[1, ", "[2, ")).replace("}]", "}, {\"id\": 8}]");
    refused("two faults", &bench, &ask(&bench, &both, &[]), "I005", &["(id 7)", "(id 8)"]);
    let missing = seeone(["ik", "--targets", &bench.arg("none.json")]);
    refused("missing", &bench, &missing, "I001", &["none.json"]);
    let unnamed = seeone(["ik", "--path"]);
    refused("unnamed", &bench, &unnamed, "I001", &["--targets"]);
}

#[test]
fn a_robot_that_cannot_be_asked_is_told() {
    let targets = with_rows("[1, 0, 0, 0.4], [0, 1, 0, 0.1], [0, 0, 1, 0.4]");
    for (case, line, says) in [
        ("home of two joints", "home_rad = [0.0, 1.0]", "2 positions"),
        ("home outside", "home_rad = [0.0, 0.0, 9.0, 0.0, 0.0, 0.0]", "elbow_joint"),
    ] {
        let bench = Bench::new();
        bench.set_line("robots/ur5-ag95-sim.toml", "home_rad", line);
        refused(case, &bench, &ask(&bench, &targets, &[]), "R013", &["ur5-ag95-sim.toml", says]);
    }
    let bench = Bench::new();
    let text = bench.text("robots/ur5-ag95.urdf").replace("\"tool0\"", "\"hand\"");
    bench.write("robots/ur5-ag95.urdf", text);
    refused("no flange", &bench, &ask(&bench, &targets, &[]), "R010", &["tool0"]);
    let bench = Bench::new();
    let unknown = ask(&bench, &targets, &["--method", "kinematics=magic"]);
    refused("unknown plugin", &bench, &unknown, "M001", &["magic", "qp-ik"]);
    for opening in ["nan", "0.5"] {
        let wide = ask(&bench, &targets, &["--opening", opening]);
        refused("opening", &bench, &wide, "I006", &["--opening", "0.095 m"]);
    }
    let other = ask(&bench, &targets, &["--method", "motion=joint-line"]);
    refused("another kind", &bench, &other, "M003", &["motion"]);
}
