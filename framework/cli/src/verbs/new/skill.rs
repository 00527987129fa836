//! `new skill`: a skill to begin with, from the demonstration of another.

use super::{check_name, check_vacant};
use crate::args::NewSkillArgs;
use crate::faults::Faults;
use crate::outputs::{make_folder, write_file};
use crate::{Ending, builtin, console};
use anyhow::{Context, Result};
use seeone_runtime::files::Skill;
use std::fs;
use std::path::PathBuf;

/// Writes `NAME.toml` and the clouds of its demonstration into the folder `NAME` beside it.
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
    let mut clouds = vec![moved(&mut skill.demonstration.cloud, own.join("demonstration.ply"))?];
    if let Some(result) = &mut skill.result {
        clouds.push(moved(&mut result.cloud, own.join("result.ply"))?);
    }
    skill.name.clone_from(&args.name);
    let text = header(&args.from.display().to_string()) + &skill.to_toml(&args.folder)?;
    make_folder(&own)?;
    for (path, cloud) in clouds.iter().chain([&(path.clone(), text.into_bytes())]) {
        write_file(path, cloud)?;
        console::tell(&format!("wrote {}", path.display()));
    }
    console::tell(&format!("next: seeone check {0} && seeone run {0} --dry-run", path.display()));
    Ok(Ending::Success)
}

/// Names a cloud `to` from now on: with its bytes.
fn moved(cloud: &mut PathBuf, to: PathBuf) -> Result<(PathBuf, Vec<u8>)> {
    let bytes =
        fs::read(&*cloud).with_context(|| format!("cannot read the cloud {}", cloud.display()))?;
    cloud.clone_from(&to);
    Ok((to, bytes))
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
