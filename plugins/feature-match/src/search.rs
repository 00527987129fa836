//! Grid, soft minimum, polish.

use crate::config::Config;
use crate::grid::Grid;
use crate::matching::Matching;
use nalgebra::Vector3;
use seeone_plugin::PluginError;

/// What the search found.
#[derive(Clone, Debug)]
pub(crate) struct Found {
    /// Offset and loss of the polished soft minimum.
    pub best: (Vector3<f64>, f64),
    /// Offset and loss of other minima of the grid, least loss first.
    pub others: Vec<(Vector3<f64>, f64)>,
    /// How far the losses narrow the place down, in `[0, 1]`: zero where every pose of the
    /// grid is as good, one where a single one is.
    pub certainty: f64,
    /// Loss of the demonstrated pose.
    pub unmoved: f64,
}

/// Searches the grid of `config`.
pub(crate) fn search(matching: &Matching, config: &Config) -> Result<Found, PluginError> {
    let grid = Grid::new(config.axes());
    let losses = matching.losses(&grid.offsets)?;
    let shares = soft_minimum(&losses, config.temperature);
    let mean: Vector3<f64> = grid.offsets.iter().zip(&shares).map(|(o, s)| o * *s).sum();
    let deepest = grid.deepest(&losses);
    let soft = (mean, matching.loss(&mean)?);
    // Between two valleys the soft minimum lies on the ridge; the deeper valley is taken.
    let ridge = soft.1 > losses[deepest] + config.temperature;
    let start = if ridge { (grid.offsets[deepest], losses[deepest]) } else { soft };
    let best = polish(matching, &grid, start)?;
    let cell = grid.cell();
    let elsewhere = |o: &Vector3<f64>| (o - best.0).iter().zip(&cell).any(|(d, c)| d.abs() > *c);
    let others = grid
        .local_minima(&losses)
        .into_iter()
        .map(|i| (grid.offsets[i], losses[i]))
        .filter(|(offset, _)| elsewhere(offset))
        .take(config.alternatives)
        .collect();
    Ok(Found {
        best,
        others,
        certainty: certainty(&grid, &shares, &mean),
        unmoved: matching.loss(&Vector3::zeros())?,
    })
}

/// softmax(-loss / temperature): the share of each place in the soft minimum.
fn soft_minimum(losses: &[f64], temperature: f64) -> Vec<f64> {
    let least = losses.iter().copied().fold(f64::INFINITY, f64::min);
    let shares: Vec<f64> = losses.iter().map(|l| ((least - l) / temperature).exp()).collect();
    let total: f64 = shares.iter().sum();
    shares.into_iter().map(|s| s / total).collect()
}

/// One minus the spread of the soft minimum over the spread of the grid.
fn certainty(grid: &Grid, shares: &[f64], mean: &Vector3<f64>) -> f64 {
    let even = 1.0 / grid.offsets.len() as f64;
    let spread: f64 =
        grid.offsets.iter().zip(shares).map(|(o, s)| s * (o - mean).norm_squared()).sum();
    let widest: f64 = grid.offsets.iter().map(|o| even * o.norm_squared()).sum();
    if widest > 0.0 { (1.0 - (spread / widest).sqrt()).clamp(0.0, 1.0) } else { 0.0 }
}

/// The least of the parabolas through the losses half a cell to either side, axis by axis,
/// no further than that half cell; `start` where they have no least or it is no better.
fn polish(
    matching: &Matching,
    grid: &Grid,
    start: (Vector3<f64>, f64),
) -> Result<(Vector3<f64>, f64), PluginError> {
    let mut best = start;
    for axis in 0..3 {
        let half = 0.5 * grid.cell()[axis];
        if half == 0.0 {
            continue;
        }
        let mut step = Vector3::zeros();
        step[axis] = half;
        let sides = matching.losses(&[best.0 - step, best.0 + step])?;
        let curvature = sides[0] - 2.0 * best.1 + sides[1];
        if curvature <= 0.0 {
            continue;
        }
        let share = (0.5 * (sides[0] - sides[1]) / curvature).clamp(-1.0, 1.0);
        let tried = best.0 + step * share;
        let loss = matching.loss(&tried)?;
        if loss < best.1 {
            best = (tried, loss);
        }
    }
    Ok(best)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_soft_minimum_sums_to_one_and_sharpens_with_the_cold() {
        let losses = [0.3, 0.1, 0.2];
        let warm = soft_minimum(&losses, 1.0);
        let cold = soft_minimum(&losses, 0.001);
        assert!((warm.iter().sum::<f64>() - 1.0).abs() < 1e-12);
        assert!(warm[1] < 0.4 && cold[1] > 0.999, "{warm:?} {cold:?}");
    }
}
