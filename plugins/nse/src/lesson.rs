//! The samples of the training: a perceived cloud, and queries whose winding numbers are
//! known.

use crate::network::{Network, SIDES};
use crate::{Input, NseError, Supervision};
use candle_core::{Device, Result, Tensor};
use rand::RngExt;
use rayon::prelude::*;
use seeone_core::TriangleMesh;
use seeone_core::random::{generator, uniform};
use seeone_nn::volume::Occupancy;
use std::ops::Range;

/// Query points whose winding numbers are computed for each object, once.
const QUERIES_PER_OBJECT: usize = 6000;
/// Of these, a sample asks for so many.
const QUERIES_PER_SAMPLE: usize = 1500;
/// A sample keeps at least this share of a cloud's points, so that the network does not
/// rely on any single one.
const LEAST_KEPT: f64 = 0.6;

/// A perceived frame of a known object.
pub(crate) struct Lesson {
    /// Number of the object in its set.
    pub(crate) object: usize,
    pub(crate) input: Input,
}

/// All lessons and what there is to know about their objects.
pub(crate) struct Lessons {
    lessons: Vec<Lesson>,
    supervision: Vec<Supervision>,
    seed: u64,
}

impl Lessons {
    /// `meshes`: the canonical mesh of each object. Winding numbers are computed here, on
    /// all cores.
    pub(crate) fn new(
        lessons: Vec<Lesson>,
        meshes: &[TriangleMesh],
        seed: u64,
    ) -> std::result::Result<Self, NseError> {
        let refuse = |why: &str| Err(NseError::Data(why.into()));
        let Some(first) = lessons.first() else {
            return refuse("the perception made nothing of its frames");
        };
        if lessons.iter().any(|l| l.input.columns != first.input.columns) {
            return refuse("the perception gave feature rows of different lengths");
        }
        let supervision = meshes
            .par_iter()
            .enumerate()
            .map(|(i, m)| Supervision::new(m, QUERIES_PER_OBJECT, seed, &format!("queries {i}")))
            .collect();
        Ok(Self { lessons, supervision, seed })
    }

    /// Length of a row of the network's input.
    pub(crate) fn columns(&self) -> usize {
        self.lessons[0].input.columns
    }

    /// The mean absolute error of the winding number over the samples with these numbers
    /// (Eq. 5). A sample is a function of the seed and its number.
    pub(crate) fn loss(&self, network: &Network, samples: Range<u64>) -> Result<Tensor> {
        let (mut positions, mut rows, mut queries, mut winding) = (vec![], vec![], vec![], vec![]);
        for number in samples {
            let mut rng = generator(self.seed, &format!("nse sample {number}"));
            let lesson = &self.lessons[rng.random_range(0..self.lessons.len())];
            let (input, known) = (&lesson.input, &self.supervision[lesson.object]);
            let kept = uniform(&mut rng, LEAST_KEPT, 1.0);
            let mut own = Vec::with_capacity(input.positions.len());
            for (position, row) in
                input.positions.iter().zip(input.rows.chunks_exact(input.columns))
            {
                if rng.random::<f64>() < kept {
                    own.push(*position);
                    rows.extend_from_slice(row);
                }
            }
            positions.push(own);
            let start = rng.random_range(0..=QUERIES_PER_OBJECT - QUERIES_PER_SAMPLE);
            queries.push(&known.queries[start..start + QUERIES_PER_SAMPLE]);
            winding.extend_from_slice(&known.winding[start..start + QUERIES_PER_SAMPLE]);
        }
        let clouds: Vec<&[[f32; 3]]> = positions.iter().map(Vec::as_slice).collect();
        let shape = (rows.len() / self.columns(), self.columns());
        let rows = Tensor::from_vec(rows, shape, &Device::Cpu)?;
        let volume = network.volume(&rows, &Occupancy::new(&clouds, SIDES[0]))?;
        let [_, _, predicted] = network.query(&volume, &queries)?;
        let truth = Tensor::from_vec(winding, predicted.dims(), &Device::Cpu)?;
        (predicted - truth)?.abs()?.mean_all()
    }
}
