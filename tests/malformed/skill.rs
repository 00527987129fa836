//! Skill files.

use crate::support::{Bench, seeone};
use crate::{SKILL, each_is_refused, refused};

#[test]
fn a_wrong_line_of_a_skill_is_told() {
    each_is_refused(
        SKILL,
        &[
            ("syntax", "name", "name = cap wearing", "S002", ""),
            ("unknown key", "lift_m", "lift_mm = 3.0", "S012", "did you mean \"lift_m\"?"),
            ("not finite", "lift_m", "lift_m = nan", "S003", "nan is not a finite number"),
            ("wrong type", "lift_m", "lift_m = \"high\"", "S013", ""),
            ("no force", "until_contact_n", "until_contact_n = -5.0", "S020", "until_contact_n"),
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
    let last = bench.set_line(SKILL, "measure", "measure = \"hang\"");
    let places = [first, last].map(|line| format!("{}:{line}:", bench.arg(SKILL)));
    refused(
        "two faults",
        &bench,
        &bench.run(&[]),
        "S020",
        &[&places[0], "error[S024]", &places[1]],
    );
}
