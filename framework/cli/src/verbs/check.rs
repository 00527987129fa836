//! `check`: the mistakes of files, told with their places, before anything moves.

use crate::args::CheckArgs;
use crate::{Ending, advice, builtin, console, files};
use anyhow::Result;
use seeone_core::Diagnostic;
use serde_json::json;

/// Checks every file and tells every fault.
///
/// # Errors
/// When standard output has gone.
pub fn run(args: &CheckArgs) -> Result<Ending> {
    let known = builtin::registry().known();
    let mut faults: Vec<Diagnostic> = Vec::new();
    for file in &args.files {
        let found = files::check(file, &known);
        if found.is_empty() && !args.json {
            console::tell(&format!("{}: no fault found", file.display()));
        }
        faults.extend(found.into_iter().map(advice::complete));
    }
    if args.json {
        let rows: Vec<_> = faults.iter().map(row).collect();
        console::answer(&serde_json::to_string_pretty(&rows)?)?;
    } else {
        faults.iter().for_each(|fault| console::tell(&format!("{fault}\n")));
    }
    Ok(if faults.is_empty() { Ending::Success } else { Ending::Failure })
}

fn row(fault: &Diagnostic) -> serde_json::Value {
    let at = fault.place.as_ref().and_then(|place| place.at);
    json!({
        "code": fault.code,
        "file": fault.place.as_ref().map(|place| place.file.display().to_string()),
        "line": at.map(|(line, _)| line),
        "column": at.map(|(_, column)| column),
        "cause": fault.cause,
        "hint": fault.hint,
    })
}
