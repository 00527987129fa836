//! What is given wrong is told with code, place and advice; nothing is left half-written,
//! nothing panics, and what is merely out of reach ends in an honest "no".

mod check;
mod cloud;
mod flags;
mod honest;
mod ik;
mod objects;
mod plugins;
mod robot;
mod scene;
mod skill;
#[path = "../support/mod.rs"]
mod support;
mod tables;
mod task;

use support::{Bench, Call};

const SKILL: &str = "skills/cap-wearing.toml";
const SCENE: &str = "scenes/head.toml";
const HOOK: &str = "scenes/hook.toml";
const ROBOT: &str = "robots/ur5-ag95-sim.toml";

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
