//! The learning curve of a training, as a table that outlives it.

use crate::chart;
use seeone_core::frames::write_whole;
use std::fmt::Write as _;
use std::io;
use std::path::{Path, PathBuf};

/// Mean losses by the number of samples seen, in a CSV file beside the checkpoint.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    path: Option<PathBuf>,
    points: Vec<(u64, f64)>,
}

const HEADER: &str = "samples,loss";
const SUFFIX: &str = ".curve.csv";

impl Curve {
    /// The curve that belongs to `checkpoint`, as far as sample `done`. What a training told
    /// after its last checkpoint is told again; a file that cannot be read starts afresh.
    pub fn resume(checkpoint: Option<&Path>, done: u64) -> Self {
        let path = checkpoint.map(|c| c.with_extension("curve.csv"));
        let text = path.as_ref().and_then(|path| std::fs::read_to_string(path).ok());
        let point = |line: &str| {
            let (samples, loss) = line.split_once(',')?;
            Some((samples.parse().ok()?, loss.parse().ok()?))
        };
        let lines = text.iter().flat_map(|text| text.lines());
        let points = lines.filter_map(point).take_while(|(samples, _)| *samples <= done).collect();
        Self { path, points }
    }

    /// Samples seen and the mean loss of those since the point before.
    pub fn points(&self) -> &[(u64, f64)] {
        &self.points
    }

    /// Adds the mean `loss` of the samples up to `samples`.
    pub fn push(&mut self, samples: u64, loss: f64) {
        self.points.push((samples, loss));
    }

    /// Writes the table, and a picture of it beside it, each in one step; without a
    /// checkpoint there are none.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn save(&self) -> io::Result<()> {
        let Some(path) = &self.path else { return Ok(()) };
        let mut text = format!("{HEADER}\n");
        for (samples, loss) in &self.points {
            let _ = writeln!(text, "{samples},{loss:.6}"); // writing to a string does not fail
        }
        write_whole(path, text.as_bytes())?;
        let title = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let title = title.strip_suffix(SUFFIX).unwrap_or(title);
        write_whole(&path.with_extension("svg"), chart::svg(title, self).as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_resumed_curve_forgets_what_came_after_the_checkpoint() {
        let folder = tempfile::tempdir().expect("a folder");
        let checkpoint = folder.path().join("a.checkpoint");
        let mut curve = Curve::resume(Some(&checkpoint), 0);
        assert!(curve.points.is_empty());
        for (samples, loss) in [(128, 4.5), (256, 3.25), (384, 2.0)] {
            curve.push(samples, loss);
        }
        curve.save().expect("written");
        assert_eq!(Curve::resume(Some(&checkpoint), 384), curve);
        let earlier = Curve::resume(Some(&checkpoint), 256);
        assert_eq!(earlier.points, [(128, 4.5), (256, 3.25)]);
    }
}
