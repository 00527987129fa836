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

/// What the perception makes of each frame, laid out for the network; `None` when
/// `progress` breaks off.
pub(crate) fn perceived(
    frames: &[&Frame],
    perceive: Perceive,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Option<Vec<Lesson>> {
    let mut lessons = Vec::with_capacity(frames.len());
    for (number, portion) in frames.chunks(AT_ONCE).enumerate() {
        let done = number * AT_ONCE;
        if progress(Progress::Perceiving { done, total: frames.len() }).is_break() {
            return None;
        }
        let made: Vec<Option<Lesson>> = portion
            .par_iter()
            .map(|frame| {
                let input = Input::new(&perceive(frame).ok()?).ok()?;
                Some(Lesson { object: frame.info.object, input })
            })
            .collect();
        lessons.extend(made.into_iter().flatten());
    }
    Some(lessons)
}

/// The canonical mesh of each object of a set.
pub(crate) fn canonical_meshes(index: &Index) -> Result<Vec<TriangleMesh>, NseError> {
    let mesh = |o: &seeone_core::frames::CanonicalObject| {
        o.mesh().map_err(|e| NseError::Data(format!("{}: {e}", o.name)))
    };
    index.objects.iter().map(mesh).collect()
}
