//! The terminal: data on standard output, everything else on standard error.

use anyhow::Result;
use std::io::Write;

/// Writes one line of data to standard output.
///
/// # Errors
/// When the reader has gone; a broken pipe is a normal end.
pub fn answer(line: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    writeln!(out, "{line}")?;
    out.flush()?;
    Ok(())
}

/// Writes one line for the reader's eyes to standard error. Nobody there is no fault.
pub fn tell(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}
