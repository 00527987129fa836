//! The offsets that are tried.

use crate::config::Axis;
use nalgebra::Vector3;

/// A box of equally spaced offsets from the demonstrated position, canonical units.
#[derive(Clone, Debug)]
pub(crate) struct Grid {
    axes: [Axis; 3],
    /// Every offset, x slowest and z fastest.
    pub offsets: Vec<Vector3<f64>>,
}

impl Grid {
    /// The grid over the axes x, y and z.
    pub fn new(axes: [Axis; 3]) -> Self {
        let [x, y, z] = axes.map(|axis| values(&axis));
        let offsets = x
            .iter()
            .flat_map(|x| y.iter().map(move |y| (*x, *y)))
            .flat_map(|(x, y)| z.iter().map(move |z| Vector3::new(x, y, *z)))
            .collect();
        Self { axes, offsets }
    }

    /// Distance between neighbours along each axis; zero along an axis of one step.
    pub fn cell(&self) -> Vector3<f64> {
        Vector3::from(self.axes.map(|axis| step(&axis)))
    }

    /// Index of the least loss; the first of equals.
    pub fn deepest(&self, losses: &[f64]) -> usize {
        (0..losses.len()).min_by(|a, b| losses[*a].total_cmp(&losses[*b])).unwrap_or_default()
    }

    /// Indices of the offsets whose loss no direct neighbour undercuts, least loss first.
    pub fn local_minima(&self, losses: &[f64]) -> Vec<usize> {
        let [_, ny, nz] = self.axes.map(|axis| axis.steps);
        let strides = [ny * nz, nz, 1];
        let lowest = |i: usize| {
            self.axes.iter().zip(strides).all(|(axis, stride)| {
                let place = i / stride % axis.steps;
                (place == 0 || losses[i] <= losses[i - stride])
                    && (place + 1 == axis.steps || losses[i] <= losses[i + stride])
            })
        };
        let mut minima: Vec<usize> = (0..losses.len()).filter(|i| lowest(*i)).collect();
        minima.sort_by(|a, b| losses[*a].total_cmp(&losses[*b]));
        minima
    }
}

fn step(axis: &Axis) -> f64 {
    2.0 * axis.reach / (axis.steps - 1).max(1) as f64
}

/// The axis' values; the middle one is exactly zero, as `steps` is odd.
fn values(axis: &Axis) -> Vec<f64> {
    let middle = (axis.steps / 2) as f64;
    (0..axis.steps).map(|i| (i as f64 - middle) * step(axis)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::Config;

    #[test]
    fn spans_its_reach_and_holds_the_demonstrated_pose() {
        let grid = Grid::new(Config::default().axes());
        assert_eq!(grid.offsets.len(), 39);
        assert_eq!(grid.offsets[19], Vector3::zeros());
        assert!((grid.offsets[0] - Vector3::new(0.0, -0.02, -0.12)).norm() < 1e-12);
        assert!((grid.offsets[38] - Vector3::new(0.0, 0.02, 0.12)).norm() < 1e-12);
        assert!((grid.cell() - Vector3::new(0.0, 0.02, 0.02)).norm() < 1e-12);
    }

    #[test]
    fn finds_every_valley_and_the_deepest_first() {
        let grid = Grid::new(Config::default().axes());
        let mut losses: Vec<f64> = (0..39).map(|i| 1.0 + 0.01 * i as f64).collect();
        losses[30] = 0.5;
        losses[7] = 0.7;
        assert_eq!(grid.local_minima(&losses), [30, 7, 0]);
    }
}
