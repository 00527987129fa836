//! Latin hypercubes of shapes.

use super::shape::{Range, Shape};
use rand::seq::SliceRandom;
use seeone_core::random::{Generator, generator, uniform};

/// `count` shapes as a Latin hypercube over `ranges`: each parameter takes every one of
/// `count` equal slices of its range exactly once (McKay, Beckman and Conover 1979).
pub fn latin_hypercube(ranges: &Shape<Range>, count: usize, seed: u64, stream: &str) -> Vec<Shape> {
    let mut rng = generator(seed, stream);
    let columns = ranges.map(|range| stratified(count, *range, &mut rng));
    (0..count).map(|i| columns.map(|values| values[i])).collect()
}

fn stratified(count: usize, (low, high): Range, rng: &mut Generator) -> Vec<f64> {
    let slice = (high - low) / count as f64;
    let mut values: Vec<f64> =
        (0..count).map(|i| low + slice * (i as f64 + uniform(rng, 0.0, 1.0))).collect();
    values.shuffle(rng);
    values
}
