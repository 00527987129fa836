//! Checking a file without running anything.

use super::codes::Family;
use super::source::Source;
use super::{KnownMethods, RobotFile, Scene, Skill, Task};
use seeone_core::Diagnostic;
use seeone_core::formats::ply;
use std::path::Path;

/// The least points of a demonstration's cloud of which anything can be learnt.
const LEAST_POINTS: usize = 100;

/// Everything that is wrong with a skill, task, scene or robot file and with the files it names;
/// nothing when it is sound.
pub fn check(path: &Path, known: &KnownMethods) -> Vec<Diagnostic> {
    let checked = family_of(path).and_then(|family| match family {
        Family::Skill => Skill::read(path, known).and_then(|skill| cloud(&skill)),
        Family::Task => Task::read(path, known)
            .and_then(|task| task.uses().into_iter().try_for_each(|used| cloud(&used.skill))),
        Family::Scene => Scene::read(path, known).map(drop),
        Family::Robot => RobotFile::read(path, known)
            .and_then(|robot| robot.model().map(drop).map_err(|fault| vec![fault])),
    });
    checked.err().unwrap_or_default()
}

/// Which kind of file it is: by its keys, or else by the folder it lies in.
///
/// # Errors
/// What keeps it from being read, or `F001` when it is none of them.
pub fn family_of(path: &Path) -> Result<Family, Vec<Diagnostic>> {
    let folder = path.parent().and_then(Path::file_name).and_then(|name| name.to_str());
    let by_folder = match folder {
        Some("skills") => Some(Family::Skill),
        Some("tasks") => Some(Family::Task),
        Some("scenes") => Some(Family::Scene),
        Some("robots") => Some(Family::Robot),
        _ => None,
    };
    let source =
        Source::open(by_folder.unwrap_or(Family::Skill), path).map_err(|fault| vec![fault])?;
    let keys = source.keys()?;
    let has = |any: &[&str]| keys.iter().any(|key| any.contains(&key.as_str()));
    let by_keys = if has(&["stage", "demonstration", "success"]) {
        Some(Family::Skill)
    } else if has(&["step"]) {
        Some(Family::Task)
    } else if has(&["urdf", "plugin", "home_rad"]) {
        Some(Family::Robot)
    } else if has(&["table", "head", "hook", "drop"]) {
        Some(Family::Scene)
    } else {
        None
    };
    by_keys.or(by_folder).ok_or_else(|| {
        let cause = "neither a skill, nor a task, nor a scene, nor a robot file";
        vec![Diagnostic::new("F001", cause).in_file(path)]
    })
}

/// The cloud of the demonstration must be one.
fn cloud(skill: &Skill) -> Result<(), Vec<Diagnostic>> {
    let path = &skill.demonstration.cloud;
    let cloud = ply::read_cloud(path).map_err(|fault| vec![fault])?;
    if cloud.len() < LEAST_POINTS {
        let cause = format!("{} points, but a demonstration needs {LEAST_POINTS}", cloud.len());
        return Err(vec![Diagnostic::new("P005", cause).in_file(path)]);
    }
    Ok(())
}
