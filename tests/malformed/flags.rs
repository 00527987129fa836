//! What stands on the command line.

use crate::support::{Bench, seeone};
use crate::{SKILL, refused};

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
        (vec!["--method", "transfer"], "KIND=NAME"),
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
fn numbers_that_make_no_sense_are_told() {
    let bench = Bench::new();
    let (skill, out) = (bench.arg(SKILL), bench.arg("out"));
    let cases: [(&[&str], &str); 9] = [
        (&["eval", &skill, "--attempts", "0"], "--attempts"),
        (&["eval", &skill, "--first-seed", "18446744073709551615"], "--first-seed"),
        (&["eval", &skill, "--jobs", "many"], "--jobs"),
        (&["run", &skill, "--tries", "0"], "--tries"),
        (&["data", "--out", &out, "--frames", "0"], "--frames"),
        (&["data", "--out", &out, "--views", "5"], "--views"),
        (&["train", "nst", "--out", &out, "--share", "nan"], "--share"),
        (&["train", "nst", "--out", &out, "--share", "-1"], "--share"),
        (&["train", "all", "--out", &out, "--share", "1e300"], "--share"),
    ];
    for (words, flag) in cases {
        let call = seeone(words);
        assert_eq!(
            (call.status, call.stdout.as_str()),
            (Some(2), ""),
            "{words:?}: {}",
            call.stderr
        );
        assert!(call.stderr.contains(flag), "{words:?}: {}", call.stderr);
    }
    assert_eq!(bench.listing("out"), [""; 0]);
}
