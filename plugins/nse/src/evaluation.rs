//! How well the encoding knows the shape of objects that it was not trained on.

use crate::perceived::{Perceive, Progress, canonical_meshes, perceived};
use crate::{Nse, NseError, Supervision};
use nalgebra::Point3;
use rayon::prelude::*;
use seeone_core::frames::{Frame, read_all};
use seeone_nn::Card;
use seeone_plugin::Field;
use std::ops::ControlFlow;
use std::path::Path;

/// Query points of each object: half uniform in the cube, half near the surface.
const QUERIES: usize = 3000;

/// What was measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figures {
    /// Frames that the encoding was asked about.
    pub frames: usize,
    /// Mean absolute error of the winding number.
    pub winding_error: f64,
    /// The same of the best constant guess, the median of the truth.
    pub constant_error: f64,
}

/// Measures the encoding behind its perception on the frames of a set that show an object
/// at rest. Frames that the perception refuses are left out. `None` when `progress` breaks
/// off.
///
/// # Errors
/// [`NseError::File`] when the set cannot be read, [`NseError::Data`] when no frame is
/// left, and what the encoding says.
pub fn evaluate(
    nse: &Nse,
    data: &Path,
    perceive: Perceive,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<Option<Figures>, NseError> {
    let (index, frames) = read_all(data)?;
    let settled: Vec<&Frame> = frames.iter().filter(|f| f.info.at_rest()).collect();
    let Some(lessons) = perceived(&settled, perceive, progress)? else {
        return Ok(None);
    };
    if lessons.is_empty() {
        return Err(NseError::Data("no frame of an object at rest was perceived".into()));
    }
    let truths: Vec<Supervision> = canonical_meshes(&index)?
        .par_iter()
        .enumerate()
        .map(|(i, mesh)| Supervision::new(mesh, QUERIES, index.seed, &format!("evaluation {i}")))
        .collect();
    let mut all: Vec<f32> = truths.iter().flat_map(|t| t.winding.iter().copied()).collect();
    all.sort_by(f32::total_cmp);
    let median = f64::from(all[all.len() / 2]);
    let (mut error, mut constant) = (0.0, 0.0);
    for lesson in &lessons {
        let truth = &truths[lesson.object];
        let queries: Vec<Point3<f64>> =
            truth.queries.iter().map(|q| q.map(f64::from).into()).collect();
        let told = nse.encode_input(&lesson.input)?.winding(&queries).unwrap_or_default();
        for (told, truth) in told.iter().zip(&truth.winding) {
            error += (told - f64::from(*truth)).abs();
            constant += (median - f64::from(*truth)).abs();
        }
    }
    let count = (lessons.len() * QUERIES) as f64;
    Ok(Some(Figures {
        frames: lessons.len(),
        winding_error: error / count,
        constant_error: constant / count,
    }))
}

/// Writes figures into the card in `folder`, under names that end in that of the `set`.
///
/// # Errors
/// [`NseError::File`] when there is no card or it cannot be written.
pub fn record(folder: &Path, set: &str, figures: &Figures) -> Result<(), NseError> {
    let mut card = Card::read(folder)?;
    card.figures.extend([
        (format!("winding_error_{set}"), figures.winding_error),
        (format!("winding_error_of_a_constant_{set}"), figures.constant_error),
        (format!("frames_{set}"), figures.frames as f64),
    ]);
    Ok(card.write(folder)?)
}
