//! The canonical shape that an encoding knows, as a surface, and how near it is to the truth
//! (paper, Table 4).
//!
//! The surface is where the winding number passes a level steeply. It is compared by points
//! drawn from both surfaces by area, in units of the canonical cube.

mod distances;
mod tetrahedra;

pub use distances::{Chamfer, earth_mover};
pub use tetrahedra::Grid;

use crate::perceived::{Perceive, Progress, canonical_meshes, perceived};
use crate::surface::{SurfaceSampler, Triangle, triangles};
use crate::{Nse, NseError};
use nalgebra::Point3;
use rayon::prelude::*;
use seeone_core::TriangleMesh;
use seeone_core::frames::{Frame, read_all};
use seeone_core::random::{Generator, generator};
use seeone_core::winding::Exact;
use seeone_nn::sampling::{Point, farthest_points};
use seeone_plugin::Field;
use serde::Serialize;
use std::ops::ControlFlow;
use std::path::Path;

/// Nodes of the grid along an edge of the cube.
pub const SIDE: usize = 64;
/// The winding number that a surface passes. Halfway through a closed one it is 1/2; beside
/// an open sheet such as a visor the halves are not 0 and 1. Chosen on the validation set,
/// as is the next.
pub const LEVEL: f64 = 0.35;
/// A surface passes it at least so steeply, per cube edge; the opening of a cap does not.
pub const LEAST_SLOPE: f64 = 12.0;
/// Points for the Chamfer distance, by area.
pub const CHAMFER_POINTS: usize = 10_000;
/// Points for the earth mover's distance: so many farthest ones of those; an exact
/// assignment of more takes minutes.
pub const MOVER_POINTS: usize = 2048;

/// Distances between two surfaces, each mean over what was compared, in cube edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Distances {
    /// [`Chamfer::mean`].
    pub chamfer: f64,
    /// [`Chamfer::squared`].
    pub chamfer_squared: f64,
    /// [`earth_mover`].
    pub earth_mover: f64,
}

/// What was measured on a set.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Figures {
    /// Frames of objects at rest that were reconstructed.
    pub frames: usize,
    /// Frames on which the encoding knows no surface at all; they are in no mean.
    pub without_surface: usize,
    /// Reconstructions against the truth.
    pub told: Distances,
    /// The truth's own winding number, reconstructed in the same way, against the truth.
    pub exact: Distances,
    /// The truth against itself, drawn twice: what so many points cannot tell apart.
    pub floor: Distances,
}

/// The surface that `field` knows; nothing for a field without winding numbers.
pub fn surface(field: &dyn Field) -> Option<Vec<Triangle>> {
    let values = field.winding(&Grid::nodes(SIDE))?;
    Some(Grid::new(SIDE, values)?.level_set(LEVEL, LEAST_SLOPE))
}

/// Measures the encoding behind its perception on `frames` frames of a set, evenly spread
/// over those that show an object at rest. `None` when `progress` breaks off.
///
/// # Errors
/// [`NseError::File`] when the set cannot be read, [`NseError::Data`] when no frame is left,
/// and what the encoding says.
pub fn evaluate(
    nse: &Nse,
    data: &Path,
    frames: usize,
    perceive: Perceive,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<Option<Figures>, NseError> {
    let (index, all) = read_all(data)?;
    let settled: Vec<&Frame> = all.iter().filter(|f| f.info.at_rest()).collect();
    let count = frames.min(settled.len());
    let spread: Vec<&Frame> = (0..count).map(|i| settled[i * settled.len() / count]).collect();
    let Some(lessons) = perceived(&spread, perceive, progress)? else { return Ok(None) };
    let meshes = canonical_meshes(&index)?;
    let truths: Vec<Option<SurfaceSampler>> =
        meshes.iter().map(|mesh| SurfaceSampler::new(triangles(mesh))).collect();
    let told: Vec<Option<Distances>> = lessons
        .par_iter()
        .enumerate()
        .map(|(number, lesson)| {
            let truth = truths[lesson.object].as_ref();
            let told = surface(&nse.encode_input(&lesson.input)?);
            let mut rng = generator(number as u64, "reconstruction");
            Ok(compared(told, truth, &mut rng))
        })
        .collect::<Result<_, NseError>>()?;
    let own: Vec<Option<[Distances; 2]>> = meshes
        .par_iter()
        .zip(&truths)
        .enumerate()
        .map(|(number, (mesh, truth))| {
            let mut rng = generator(number as u64, "reconstruction floor");
            let exact = compared(Some(exact(mesh)?), truth.as_ref(), &mut rng)?;
            Some([exact, compared(Some(triangles(mesh)), truth.as_ref(), &mut rng)?])
        })
        .collect();
    let found: Vec<Distances> = told.iter().flatten().copied().collect();
    if found.is_empty() {
        return Err(NseError::Data("no frame of an object at rest has a surface".into()));
    }
    let of = |which: usize| own.iter().flatten().map(|pair| pair[which]).collect::<Vec<_>>();
    Ok(Some(Figures {
        frames: told.len(),
        without_surface: told.len() - found.len(),
        told: mean(&found),
        exact: mean(&of(0)),
        floor: mean(&of(1)),
    }))
}

/// The surface of the true winding number.
fn exact(mesh: &TriangleMesh) -> Option<Vec<Triangle>> {
    let step = 1.0 / (SIDE - 1) as f64;
    let values = Exact::new(mesh).grid(&Point3::origin(), step, [SIDE; 3]);
    Some(Grid::new(SIDE, values)?.level_set(LEVEL, LEAST_SLOPE))
}

fn compared(
    told: Option<Vec<Triangle>>,
    truth: Option<&SurfaceSampler>,
    rng: &mut Generator,
) -> Option<Distances> {
    let (told, truth) = (SurfaceSampler::new(told?)?, truth?);
    let (a, b) = (told.samples(CHAMFER_POINTS, rng), truth.samples(CHAMFER_POINTS, rng));
    let chamfer = Chamfer::between(&a, &b);
    let earth_mover = earth_mover(&spread(&a), &spread(&b))?;
    Some(Distances { chamfer: chamfer.mean, chamfer_squared: chamfer.squared, earth_mover })
}

/// The farthest points of a sample: as many random points would have gaps and heaps that cost
/// more to level than the surfaces differ.
fn spread(sample: &[Point3<f64>]) -> Vec<Point3<f64>> {
    let single: Vec<Point> = sample.iter().map(|p| p.coords.map(|v| v as f32).into()).collect();
    let rows = farthest_points(&single, MOVER_POINTS);
    rows.into_iter().map(|row| sample[row as usize]).collect()
}

fn mean(of: &[Distances]) -> Distances {
    let mean = |pick: fn(&Distances) -> f64| of.iter().map(pick).sum::<f64>() / of.len() as f64;
    Distances {
        chamfer: mean(|d| d.chamfer),
        chamfer_squared: mean(|d| d.chamfer_squared),
        earth_mover: mean(|d| d.earth_mover),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_caps::cap;

    #[test]
    fn the_true_winding_number_gives_the_cap_back_without_a_lid() {
        let mesh = cap(0.0);
        let truth = SurfaceSampler::new(triangles(&mesh));
        let mut rng = generator(1, "test");
        let found = compared(exact(&mesh), truth.as_ref(), &mut rng).expect("a surface");
        let floor = compared(Some(triangles(&mesh)), truth.as_ref(), &mut rng).expect("a surface");
        assert!(found.chamfer < 2.0 * floor.chamfer, "{found:?}, {floor:?}");
        assert!(found.earth_mover < 2.5 * floor.earth_mover, "{found:?}, {floor:?}");
    }
}
