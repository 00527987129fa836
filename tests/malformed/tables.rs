//! Small edits of sound files, each with what is told of it: one table for each kind of file in
//! `tests/malformed/files`.
//!
//! A case is a heading, the lines that are taken out (`-`) and put in (`+`), and what `check`
//! tells. `-` names a line by its beginning, as the first that begins so, or by `N:` as the Nth;
//! without one the new lines go to the end. What is told is written anew by
//! `SEEONE_WRITE_EXPECTED=1`, and read by whoever changes it.

use crate::support::{Bench, root, seeone};
use std::fmt::Write;
use std::fs;

/// A table and the sound file that its cases are edits of.
struct Table {
    name: &'static str,
    file: &'static str,
}

const TABLES: [Table; 8] = [
    Table { name: "skill", file: "skills/cap-wearing.toml" },
    Table { name: "task", file: "skills/tasks/dress.toml" },
    Table { name: "scene", file: "scenes/head.toml" },
    Table { name: "tidy-caps", file: "skills/tasks/tidy-caps.toml" },
    Table { name: "hooks", file: "scenes/hooks.toml" },
    Table { name: "robot", file: "robots/ur5-ag95-sim.toml" },
    Table { name: "urdf", file: "robots/ur5-ag95.urdf" },
    Table { name: "manifest", file: "libfamous.so.toml" },
];

/// What each case of a table is.
struct Case {
    heading: String,
    edits: Vec<String>,
    told: String,
}

/// The file's comment, and its cases.
fn parse(text: &str) -> (String, Vec<Case>) {
    let (comment, rest) = text.split_once("## ").expect("a table has cases");
    let cases = rest.split("\n## ").map(|case| {
        let mut lines = case.lines();
        let heading = lines.next().expect("a case has a heading").to_owned();
        let (edits, told): (Vec<&str>, Vec<&str>) =
            lines.partition(|line| line.starts_with("- ") || line.starts_with('+'));
        let edits = edits.into_iter().map(str::to_owned).collect();
        Case { heading, edits, told: told.join("\n").trim().to_owned() }
    });
    (comment.to_owned(), cases.collect())
}

/// The sound text with the edits of a case.
fn edited(sound: &str, case: &Case) -> String {
    let mut lines: Vec<&str> = sound.lines().collect();
    let mut at = None;
    for edit in &case.edits {
        match edit.split_at(1) {
            ("-", line) => {
                let line = line.trim_start();
                let (nth, start) = match line.split_once(": ") {
                    Some((n, start)) if n.parse::<usize>().is_ok() => {
                        (n.parse().unwrap_or(1), start)
                    }
                    _ => (1, line),
                };
                let mut found =
                    lines.iter().enumerate().filter(|(_, l)| l.trim_start().starts_with(start));
                let (index, _) = found
                    .nth(nth - 1)
                    .unwrap_or_else(|| panic!("{}: no line begins with {start:?}", case.heading));
                lines.remove(index);
                at = Some(index);
            }
            (_, line) => {
                let index = at.unwrap_or(lines.len());
                lines.insert(index, line.strip_prefix(' ').unwrap_or(line));
                at = Some(index + 1);
            }
        }
    }
    lines.join("\n") + "\n"
}

#[test]
fn every_small_edit_that_spoils_a_file_is_told_with_its_place() {
    let (mut count, mut taken) = (0, Vec::new());
    for table in TABLES {
        let path = root().join(format!("tests/malformed/files/{}.txt", table.name));
        let text = fs::read_to_string(&path).expect("a table");
        let (comment, mut cases) = parse(&text);
        let bench = Bench::new();
        trusted(&bench);
        let sound = bench.text(table.file);
        assert_eq!(told(&bench, table.file), "", "{} itself", table.file);
        let mut written = comment;
        for case in &mut cases {
            bench.write(table.file, edited(&sound, case));
            let told = told(&bench, table.file);
            bench.write(table.file, &sound);
            if told.is_empty() {
                taken.push(format!("{}: {}", table.name, case.heading));
            }
            for line in told.lines().filter(|line| line.starts_with("error[")) {
                let place = line.split(": ").nth(1).unwrap_or_default();
                assert!(
                    place.contains('.'),
                    "{}: {} has no file: {line}",
                    table.name,
                    case.heading
                );
            }
            let edits: String = case.edits.iter().map(|edit| format!("{edit}\n")).collect();
            writeln!(written, "## {}\n{edits}{told}\n", case.heading).expect("text");
            if std::env::var_os("SEEONE_WRITE_EXPECTED").is_none() {
                assert_eq!(case.told, told, "{}: {}", table.name, case.heading);
            }
            count += 1;
        }
        if std::env::var_os("SEEONE_WRITE_EXPECTED").is_some() {
            fs::write(&path, written.trim_end().to_owned() + "\n").expect("a written table");
        }
    }
    assert_eq!(taken, [""; 0], "these are taken");
    assert!(count >= 160, "{count} cases");
}

/// Puts a library into the bench that is sound by its manifest, as far as that is told without
/// loading it.
fn trusted(bench: &Bench) {
    let library = "no library, but sound by its manifest";
    let manifest = include_str!("files/famous.so.toml");
    let hash = blake3::hash(library.as_bytes()).to_hex();
    bench.write("libfamous.so", library);
    bench.write("libfamous.so.toml", manifest.replace("HASH", hash.as_str()));
}

/// What `check` tells of a file of the bench, without the bench's folder.
fn told(bench: &Bench, file: &str) -> String {
    // An arm is checked by the robot file that names it.
    let checked = if file.ends_with(".urdf") { "robots/ur5-ag95-sim.toml" } else { file };
    let call = seeone(["check", &bench.arg(checked)]);
    let told = call.stderr.replace(&bench.arg(""), "");
    match call.status {
        Some(0) => String::new(),
        Some(1) => told.lines().filter(|line| !line.is_empty()).collect::<Vec<_>>().join("\n"),
        other => panic!("{file}: exit status {other:?}: {told}"),
    }
}
