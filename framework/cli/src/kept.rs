//! Attempts kept in a file while an evaluation runs, so that one that was stopped goes on.
//!
//! The file is lines of JSON: the fingerprint of what the evaluation is made of, then one
//! attempt a line, in the order in which they ended. A last line that was cut is made again.

use anyhow::Result;
use seeone_core::Diagnostic;
use seeone_runtime::run::Outcome;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The file's first line.
#[derive(Serialize, Deserialize)]
struct Header {
    seeone_eval: u32,
    fingerprint: String,
}

const SCHEMA: u32 = 1;

/// The file, and the attempts that were in it.
pub struct Kept {
    path: PathBuf,
    file: Mutex<File>,
    found: BTreeMap<u64, Outcome>,
}

impl Kept {
    /// Opens the file, or makes it.
    ///
    /// # Errors
    /// `F003` when it cannot be read or written, `F004` when it holds something else, or the
    /// attempts of another evaluation: nothing is written then.
    pub fn open(path: &Path, fingerprint: String) -> Result<Self, Diagnostic> {
        let header = Header { seeone_eval: SCHEMA, fingerprint };
        let failed = |e: std::io::Error| unwritten(path, &e);
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(path)
            .map_err(failed)?;
        let text = fs::read_to_string(path).map_err(failed)?;
        let (found, whole) = read(path, &text, &header.fingerprint)?;
        file.set_len(whole as u64).map_err(failed)?;
        file.seek(SeekFrom::End(0)).map_err(failed)?;
        if whole == 0 {
            write_line(&mut file, &header).map_err(failed)?;
        }
        Ok(Self { path: path.to_owned(), file: Mutex::new(file), found })
    }

    /// The attempt of this seed, if it was made before.
    pub fn outcome(&self, seed: u64) -> Option<&Outcome> {
        self.found.get(&seed)
    }

    /// Adds an attempt.
    ///
    /// # Errors
    /// `F003` when it cannot be written.
    pub fn keep(&self, outcome: &Outcome) -> Result<(), Diagnostic> {
        // A thread that panicked left whole lines behind.
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        write_line(&mut file, outcome).map_err(|e| unwritten(&self.path, &e))
    }
}

/// The attempts of the file's whole lines, and how many bytes those take.
fn read(
    path: &Path,
    text: &str,
    fingerprint: &str,
) -> Result<(BTreeMap<u64, Outcome>, usize), Diagnostic> {
    let whole = text.rfind('\n').map_or(0, |end| end + 1);
    let other = |cause: &str| {
        Diagnostic::new("F004", cause)
            .in_file(path)
            .hint("name another file with --keep, or one that is not there yet")
    };
    let mut lines = text[..whole].lines().enumerate();
    match lines.next() {
        None if text.is_empty() => return Ok((BTreeMap::new(), 0)),
        None => return Err(other("the file holds something else than attempts")),
        Some((_, line)) => match serde_json::from_str::<Header>(line) {
            Ok(header) if header.seeone_eval == SCHEMA => {
                if header.fingerprint != fingerprint {
                    return Err(other("the file holds the attempts of another evaluation"));
                }
            }
            _ => return Err(other("the file holds something else than attempts")),
        },
    }
    let mut found = BTreeMap::new();
    for (number, line) in lines {
        let outcome: Outcome = serde_json::from_str(line).map_err(|e| {
            other(&format!("no attempt: {e}")).at_line(path, number + 1, e.column().max(1))
        })?;
        found.insert(outcome.seed, outcome);
    }
    Ok((found, whole))
}

fn write_line(file: &mut File, line: &impl Serialize) -> std::io::Result<()> {
    let mut bytes = serde_json::to_vec(line)?;
    bytes.push(b'\n');
    // One write a line: a kill leaves whole lines, but for the last.
    file.write_all(&bytes)?;
    file.flush()
}

fn unwritten(path: &Path, error: &std::io::Error) -> Diagnostic {
    Diagnostic::new("F003", format!("cannot keep attempts in the file: {error}"))
        .in_file(path)
        .hint("name another place with --keep")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(seed: u64) -> Outcome {
        let text = format!(
            r#"{{"skill": "wear", "object": "cap", "robot": "arm", "seed": {seed},
                "methods": {{"camera": "camera-sim", "transfer": "unchanged"}}, "tries": 1,
                "failed_at": null, "grasped": true, "success": true, "error_m": 0.012345678901234567,
                "error_d": 0.1, "tilt_deg": 3.0, "nose_up_deg": 2.0, "yaw_deg": -1.0, "reason": "worn",
                "stages": [{{"name": "observe", "ok": true, "seconds": 0.25, "reason": null}}],
                "timings_ms": {{"observe": 250.1}}, "recording": null}}"#
        );
        serde_json::from_str(&text).expect("an outcome")
    }

    #[test]
    fn what_was_kept_is_found_again_and_a_cut_line_is_not() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("attempts.jsonl");
        let kept = Kept::open(&path, "one".into()).expect("made");
        (0..3).for_each(|seed| kept.keep(&outcome(seed)).expect("kept"));
        let text = fs::read_to_string(&path).expect("read");
        fs::write(&path, &text[..text.len() - 40]).expect("cut");

        let kept = Kept::open(&path, "one".into()).expect("opened");
        assert_eq!(kept.outcome(1), Some(&outcome(1)));
        assert_eq!(kept.outcome(2), None, "its line was cut");
        kept.keep(&outcome(2)).expect("kept");
        assert_eq!(fs::read_to_string(&path).expect("read"), text);
    }

    #[test]
    fn another_file_is_refused_and_left_as_it_is() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("attempts.jsonl");
        Kept::open(&path, "one".into()).expect("made");
        let mut cases = vec![fs::read_to_string(&path).expect("read")];
        cases.extend(["notes\n".to_owned(), "no end".to_owned(), "{}\n".to_owned()]);
        for text in cases {
            fs::write(&path, &text).expect("written");
            let Err(fault) = Kept::open(&path, "two".into()) else { panic!("taken: {text}") };
            assert_eq!(fault.code, "F004");
            assert_eq!(fs::read_to_string(&path).expect("read"), text);
        }
    }
}
