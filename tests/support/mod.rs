//! The real binary, run on copies of the shipped files.

#![allow(dead_code, reason = "each test target uses a part of it")]

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// The repository's root: the binary's working directory, as documented.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the repository")
}

/// How one call of the binary ended.
#[derive(Debug)]
pub struct Call {
    /// Exit status; `None` when a signal ended it.
    pub status: Option<i32>,
    /// Data.
    pub stdout: String,
    /// What was told.
    pub stderr: String,
}

/// Calls the binary from the repository's root.
pub fn seeone<I: IntoIterator<Item: AsRef<OsStr>>>(arguments: I) -> Call {
    let output = Command::new(env!("CARGO_BIN_EXE_seeone"))
        .args(arguments)
        .current_dir(root())
        .output()
        .expect("the binary starts");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("UTF-8 text");
    let call = Call {
        status: output.status.code(),
        stdout: text(output.stdout),
        stderr: text(output.stderr),
    };
    assert!(!call.stderr.contains("panicked"), "{}", call.stderr);
    call
}

/// A folder with copies of the shipped skill, scene and robot, to be changed at will.
pub struct Bench {
    folder: TempDir,
}

impl Bench {
    /// The shipped files as they are.
    pub fn new() -> Self {
        let bench = Self { folder: tempfile::tempdir().expect("a temporary folder") };
        for name in [
            "skills/cap-wearing.toml",
            "skills/cap-wearing/demonstration.ply",
            "skills/cap-wearing/result.ply",
            "skills/tasks/dress.toml",
            "skills/cap-hanging.toml",
            "skills/cap-hanging/demonstration.ply",
            "skills/tasks/tidy-caps.toml",
            "scenes/head.toml",
            "scenes/hooks.toml",
            "robots/ur5-ag95-sim.toml",
            "robots/ur5-ag95.urdf",
        ] {
            bench.copy(name);
        }
        bench
    }

    /// A copy of another shipped file.
    pub fn copy(&self, name: &str) {
        let to = self.path(name);
        fs::create_dir_all(to.parent().expect("a folder")).expect("a folder");
        fs::copy(root().join(name), to).expect("a shipped file");
    }

    /// The path of something in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The same as an argument.
    pub fn arg(&self, name: &str) -> String {
        self.path(name).display().to_string()
    }

    /// Writes a file.
    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.path(name), bytes).expect("a written file");
    }

    /// The text of a file.
    pub fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).expect("a text file")
    }

    /// Replaces the first line that begins with `start`; returns its number.
    pub fn set_line(&self, name: &str, start: &str, line: &str) -> usize {
        let text = self.text(name);
        let at = text.lines().position(|l| l.starts_with(start)).expect("a line to replace");
        let lines = text.lines().enumerate().map(|(i, old)| if i == at { line } else { old });
        self.write(name, lines.map(|line| format!("{line}\n")).collect::<String>());
        at + 1
    }

    /// Adds text at the end of a file.
    pub fn append(&self, name: &str, addition: &str) {
        self.write(name, self.text(name) + addition);
    }

    /// The names of the files in a folder; none when there is no such folder.
    pub fn listing(&self, name: &str) -> Vec<String> {
        let Ok(entries) = fs::read_dir(self.path(name)) else { return Vec::new() };
        let mut names: Vec<String> = entries
            .map(|e| e.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    /// Runs the skill, scene and robot of this folder with `extra` arguments, into `out`.
    pub fn run(&self, extra: &[&str]) -> Call {
        let mut arguments = vec!["run".to_owned(), self.arg("skills/cap-wearing.toml")];
        for (flag, name) in [
            ("--scene", "scenes/head.toml"),
            ("--robot", "robots/ur5-ag95-sim.toml"),
            ("--out", "out"),
        ] {
            arguments.extend([flag.to_owned(), self.arg(name)]);
        }
        arguments.extend(extra.iter().map(|&word| word.to_owned()));
        seeone(arguments)
    }
}
