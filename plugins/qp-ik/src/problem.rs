//! A small quadratic program.

use nalgebra::{DMatrix, DVector};

/// Minimise `x^T hessian x / 2 - pull^T x` within `lower <= x <= upper` and `rows x <= bounds`.
#[derive(Clone, Copy, Debug)]
pub struct Problem<'a> {
    /// Symmetric and positive definite, `n` by `n`.
    pub hessian: &'a DMatrix<f64>,
    /// `n` numbers.
    pub pull: &'a DVector<f64>,
    /// `n` numbers, none above its upper one.
    pub lower: &'a DVector<f64>,
    /// `n` numbers.
    pub upper: &'a DVector<f64>,
    /// `m` by `n`.
    pub rows: &'a DMatrix<f64>,
    /// `m` numbers.
    pub bounds: &'a DVector<f64>,
}

impl Problem<'_> {
    /// Number of rows, `row x <= bound`: first the upper bounds, then the lower ones, then the rest.
    pub(crate) fn rows(&self) -> usize {
        2 * self.pull.len() + self.bounds.len()
    }

    /// A coefficient of a row.
    pub(crate) fn entry(&self, row: usize, column: usize) -> f64 {
        let n = self.pull.len();
        match row / n {
            0 if row == column => 1.0,
            1 if row == n + column => -1.0,
            0 | 1 => 0.0,
            _ => self.rows[(row - 2 * n, column)],
        }
    }

    /// A row times `x`.
    pub(crate) fn along(&self, row: usize, x: &DVector<f64>) -> f64 {
        let n = self.pull.len();
        match row / n {
            0 => x[row],
            1 => -x[row - n],
            _ => (0..n).map(|column| self.rows[(row - 2 * n, column)] * x[column]).sum(),
        }
    }

    /// The largest bound of a joint.
    pub(crate) fn longest(&self) -> f64 {
        self.upper.amax().max(self.lower.amax())
    }

    /// A row's bound.
    pub(crate) fn bound(&self, row: usize) -> f64 {
        let n = self.pull.len();
        match row / n {
            0 => self.upper[row],
            1 => -self.lower[row - n],
            _ => self.bounds[row - 2 * n],
        }
    }
}
