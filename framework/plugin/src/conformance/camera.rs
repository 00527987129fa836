//! The rules of kind `camera`.

use super::violation::{Violation, answered, hold, sound};
use crate::{Camera, PluginError};

/// Holds every rule of the kind for the cameras that `build` makes, one for each look at the
/// same cell with the same seed.
///
/// # Errors
/// The first rule that they break.
pub fn camera(build: &dyn Fn() -> Result<Box<dyn Camera>, PluginError>) -> Result<(), Violation> {
    let rule = "a camera can be built";
    let mut first = answered(rule, build)?;
    let mut second = answered(rule, build)?;
    for _ in 0..2 {
        let rule = "finite in, finite and of the image's size out";
        let seen = answered(rule, || first.observe())?;
        sound(rule, seen.check())?;
        let rule = "the same cell and seed give the same bytes";
        let again = answered(rule, || second.observe())?;
        let same = seen.depth == again.depth
            && seen.cloud == again.cloud
            && seen.camera_position == again.camera_position;
        hold(rule, same, || {
            format!("{} points and {} points", seen.cloud.len(), again.cloud.len())
        })?;
    }
    Ok(())
}
