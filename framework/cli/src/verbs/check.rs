//! `check`: the mistakes of files, told with their places, before anything moves.

use crate::args::CheckArgs;
use crate::faults::Faults;
use crate::files::Against;
use crate::fits::Reach;
use crate::{Ending, advice, builtin, console};
use anyhow::Result;
use seeone_core::Diagnostic;
use seeone_runtime::files::{RobotFile, Scene};
use serde_json::json;

/// Checks every file and tells every fault.
///
/// # Errors
/// Every fault of the robot or the scene that is checked against; a library that is not trusted; when standard output has gone.
pub fn run(args: &CheckArgs) -> Result<Ending> {
    let against = against(args)?;
    let mut faults: Vec<Diagnostic> = Vec::new();
    for file in &args.files {
        let found = against.check(file);
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

fn against(args: &CheckArgs) -> Result<Against> {
    let mut registry = builtin::registry();
    builtin::load(&mut registry, &args.libraries)?;
    let known = registry.known();
    let scene = args.scene.as_ref().map(|path| Scene::read(path, &known).map_err(Faults));
    let file = args.robot.as_ref().map(|path| RobotFile::read(path, &known).map_err(Faults));
    let reach = file.transpose()?.map(|file| Reach::of(&file, &registry)).transpose()?;
    Ok(Against { reach, scene: scene.transpose()?, registry })
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
