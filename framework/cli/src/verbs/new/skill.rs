//! `new skill`: a skill to begin with, from the demonstration of another.

use super::{check_name, check_vacant};
use crate::args::NewSkillArgs;
use crate::faults::Faults;
use crate::outputs::{make_folder, write_file};
use crate::{Ending, builtin, console};
use anyhow::{Context, Result};
use seeone_runtime::files::Skill;
use std::fs;

/// Writes `NAME.toml` and the cloud of its demonstration into the folder `NAME` beside it.
///
/// # Errors
/// Every fault of the skill it is begun from, a name that is none, files that are there already
/// or cannot be written.
pub fn run(args: &NewSkillArgs) -> Result<Ending> {
    let mut skill = Skill::read(&args.from, &builtin::registry().known()).map_err(Faults)?;
    let path = args.folder.join(format!("{}.toml", args.name));
    let own = args.folder.join(&args.name);
    check_name(&args.name)?;
    check_vacant(&[&path, &own])?;
    let shown = skill.demonstration.cloud.clone();
    let cloud =
        fs::read(&shown).with_context(|| format!("cannot read the cloud {}", shown.display()))?;
    skill.name.clone_from(&args.name);
    skill.demonstration.cloud = own.join("demonstration.ply");
    let text = header(&args.from.display().to_string()) + &skill.to_toml(&args.folder)?;
    make_folder(&own)?;
    write_file(&skill.demonstration.cloud, &cloud)?;
    write_file(&path, text.as_bytes())?;
    for made in [&path, &skill.demonstration.cloud] {
        console::tell(&format!("wrote {}", made.display()));
    }
    console::tell(&format!("next: seeone check {0} && seeone run {0} --dry-run", path.display()));
    Ok(Ending::Success)
}

/// What a skill's author does next.
fn header(from: &str) -> String {
    format!(
        "# Begun from {from}. To make it your own:\n\
         # - record the object's cloud before the first stage (PLY, metres, `world`) over the one in the\n\
         #   folder of this skill's name, and say where the camera stood;\n\
         # - give the frames that stages are relative to, and a [[stage]] for each key pose, the first of\n\
         #   them relative to the object;\n\
         # - keep [methods] only where the skill cannot do with the default plugin of a kind.\n\
         # `seeone schema skill` tells every key; `seeone check` what is wrong.\n"
    )
}
