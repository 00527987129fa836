//! What a frozen perception makes of a set of frames.

use crate::lesson::Lesson;
use crate::{Input, NseError};
use rayon::prelude::*;
use seeone_core::TriangleMesh;
use seeone_core::frames::{Frame, Index};
use seeone_plugin::{CanonicalCloud, PluginError};
use std::ops::ControlFlow;

/// Frames perceived between two reports.
const AT_ONCE: usize = 32;

/// How far a training has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Progress {
    /// The frozen perception is asked once for each frame.
    Perceiving {
        /// Frames done.
        done: usize,
        /// Frames in all.
        total: usize,
    },
    /// The networks U and M learn.
    Training(seeone_nn::Progress),
}

/// The frozen perception: what it makes of a frame.
pub type Perceive<'a> = &'a (dyn Fn(&Frame) -> Result<CanonicalCloud, PluginError> + Sync);

/// What the perception makes of each frame, laid out for the network, without the frames
/// that it refuses; `None` when `progress` breaks off.
pub(crate) fn perceived(
    frames: &[&Frame],
    perceive: Perceive,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<Option<Vec<Lesson>>, NseError> {
    let mut lessons = Vec::with_capacity(frames.len());
    for (number, portion) in frames.chunks(AT_ONCE).enumerate() {
        let done = number * AT_ONCE;
        if progress(Progress::Perceiving { done, total: frames.len() }).is_break() {
            return Ok(None);
        }
        let made: Vec<Option<Lesson>> =
            portion.par_iter().map(|frame| lesson(frame, perceive)).collect::<Result<_, _>>()?;
        lessons.extend(made.into_iter().flatten());
    }
    Ok(Some(lessons))
}

fn lesson(frame: &Frame, perceive: Perceive) -> Result<Option<Lesson>, NseError> {
    let cloud = match perceive(frame) {
        Ok(cloud) => cloud,
        Err(PluginError::Input(_)) => return Ok(None),
        Err(fault) => return Err(NseError::Perception(fault)),
    };
    Ok(Input::new(&cloud).ok().map(|input| Lesson { object: frame.info.object, input }))
}

/// The canonical mesh of each object of a set.
pub(crate) fn canonical_meshes(index: &Index) -> Result<Vec<TriangleMesh>, NseError> {
    let mesh = |o: &seeone_core::frames::CanonicalObject| {
        o.mesh().map_err(|e| NseError::Data(format!("{}: {e}", o.name)))
    };
    index.objects.iter().map(mesh).collect()
}
