//! Clouds stacked for the network, with every index table that it needs.

use crate::network::Sizes;
use crate::stance::{PLACE, Stance};
use candle_core::{Device, Result, Tensor, bail};
use seeone_nn::ops::Neighborhoods;
use seeone_nn::sampling::{Interpolation, Point, ball_query, farthest_points, three_nearest};

/// Neighbours in one set abstraction.
const NEIGHBOURS: usize = 24;

/// One cloud in network units, and what is asked about it.
#[derive(Clone, Copy, Debug)]
pub struct View<'a> {
    /// The cloud, in random order: of a crowded neighbourhood the first points are taken.
    pub points: &'a [Point],
    /// Points at which coordinates are asked for.
    pub queries: &'a [Point],
    /// How the cloud was seen.
    pub stance: Stance,
}

/// A stack of clouds of equal size, in network units.
pub struct Batch {
    /// All points, rows x 3.
    pub points: Tensor,
    /// Centres of the first set abstraction, rows x 3.
    pub centres: Tensor,
    /// Centres of the second one, rows x 3.
    pub tokens: Tensor,
    /// Centres of the second one with their surroundings, rows x [`PLACE`].
    pub token_places: Tensor,
    /// Points at which coordinates are asked for with their surroundings, rows x [`PLACE`].
    pub query_places: Tensor,
    /// Points around each centre.
    pub around_centres: Neighborhoods,
    /// Centres around each token.
    pub around_tokens: Neighborhoods,
    /// Tokens near each centre.
    pub tokens_to_centres: Interpolation,
    /// Centres near each query.
    pub centres_to_queries: Interpolation,
}

fn matrix<const COLUMNS: usize>(rows: &[[f32; COLUMNS]]) -> Result<Tensor> {
    Tensor::from_vec(rows.as_flattened().to_vec(), (rows.len(), COLUMNS), &Device::Cpu)
}

fn append(table: &mut Interpolation, part: Interpolation, offset: usize) {
    table.rows.extend(part.rows.iter().map(|rows| rows.map(|row| row + offset as u32)));
    table.weights.extend(part.weights);
}

impl Batch {
    /// Stacks views.
    ///
    /// # Errors
    /// When a cloud has not exactly `sizes.points` points.
    pub fn new(sizes: Sizes, views: &[View<'_>]) -> Result<Self> {
        let (mut points, mut centres, mut tokens) = (vec![], vec![], vec![]);
        let (mut token_places, mut query_places): (Vec<[f32; PLACE]>, _) = (vec![], vec![]);
        let (mut around_centres, mut around_tokens) = (vec![], vec![]);
        let (mut to_centres, mut to_queries) = (Interpolation::default(), Interpolation::default());
        for View { points: cloud, queries: asked, stance } in views {
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
            token_places.extend(stance.places(&own_tokens, cloud));
            query_places.extend(stance.places(asked, cloud));
            points.extend_from_slice(cloud);
            centres.extend(own_centres);
            tokens.extend(own_tokens);
        }
        Ok(Self {
            points: matrix(&points)?,
            centres: matrix(&centres)?,
            tokens: matrix(&tokens)?,
            token_places: matrix(&token_places)?,
            query_places: matrix(&query_places)?,
            around_centres: Neighborhoods { rows: around_centres, size: NEIGHBOURS },
            around_tokens: Neighborhoods { rows: around_tokens, size: NEIGHBOURS },
            tokens_to_centres: to_centres,
            centres_to_queries: to_queries,
        })
    }
}
