//! Clouds stacked for the network, with every index table that it needs.

use crate::network::Sizes;
use candle_core::{Device, Result, Tensor, bail};
use seeone_nn::ops::Neighborhoods;
use seeone_nn::sampling::{Interpolation, Point, ball_query, farthest_points, three_nearest};

/// Neighbours in one set abstraction.
const NEIGHBOURS: usize = 24;

/// A stack of clouds of equal size, in network units.
pub struct Batch {
    /// All points, rows x 3.
    pub points: Tensor,
    /// Centres of the first set abstraction, rows x 3.
    pub centres: Tensor,
    /// Centres of the second one, rows x 3.
    pub tokens: Tensor,
    /// Points at which coordinates are asked for, rows x 3.
    pub queries: Tensor,
    /// Points around each centre.
    pub around_centres: Neighborhoods,
    /// Centres around each token.
    pub around_tokens: Neighborhoods,
    /// Tokens near each centre.
    pub tokens_to_centres: Interpolation,
    /// Centres near each query.
    pub centres_to_queries: Interpolation,
}

fn matrix(points: &[Point]) -> Result<Tensor> {
    Tensor::from_vec(points.as_flattened().to_vec(), (points.len(), 3), &Device::Cpu)
}

fn append(table: &mut Interpolation, part: Interpolation, offset: usize) {
    table.rows.extend(part.rows.iter().map(|rows| rows.map(|row| row + offset as u32)));
    table.weights.extend(part.weights);
}

impl Batch {
    /// Stacks `(points, queries)` of each cloud. Points should be in random order: of a
    /// crowded neighbourhood the first ones are taken.
    ///
    /// # Errors
    /// When a cloud has not exactly `sizes.points` points.
    pub fn new(sizes: Sizes, clouds: &[(&[Point], &[Point])]) -> Result<Self> {
        let (mut points, mut centres, mut tokens, mut queries) = (vec![], vec![], vec![], vec![]);
        let (mut around_centres, mut around_tokens) = (vec![], vec![]);
        let (mut to_centres, mut to_queries) = (Interpolation::default(), Interpolation::default());
        for (cloud, asked) in clouds {
            if cloud.len() != sizes.points {
                bail!("a cloud of {} points for a network of {}", cloud.len(), sizes.points);
            }
            let pick = |from: &[Point], rows: &[u32]| -> Vec<Point> {
                rows.iter().map(|row| from[*row as usize]).collect()
            };
            let centre_rows = farthest_points(cloud, sizes.centres());
            let own_centres = pick(cloud, &centre_rows);
            let token_rows = farthest_points(&own_centres, sizes.tokens());
            let own_tokens = pick(&own_centres, &token_rows);
            let shifted = |rows: Vec<u32>, by: usize| rows.into_iter().map(move |r| r + by as u32);
            let near = ball_query(cloud, &centre_rows, sizes.radii[0], NEIGHBOURS);
            around_centres.extend(shifted(near, points.len()));
            let near = ball_query(&own_centres, &token_rows, sizes.radii[1], NEIGHBOURS);
            around_tokens.extend(shifted(near, centres.len()));
            append(&mut to_centres, three_nearest(&own_centres, &own_tokens), tokens.len());
            append(&mut to_queries, three_nearest(asked, &own_centres), centres.len());
            points.extend_from_slice(cloud);
            centres.extend(own_centres);
            tokens.extend(own_tokens);
            queries.extend_from_slice(asked);
        }
        Ok(Self {
            points: matrix(&points)?,
            centres: matrix(&centres)?,
            tokens: matrix(&tokens)?,
            queries: matrix(&queries)?,
            around_centres: Neighborhoods { rows: around_centres, size: NEIGHBOURS },
            around_tokens: Neighborhoods { rows: around_tokens, size: NEIGHBOURS },
            tokens_to_centres: to_centres,
            centres_to_queries: to_queries,
        })
    }
}
