//! Cholesky factors in memory that is used again: nalgebra's own take their matrix by value,
//! which allocates one a step.

use nalgebra::{DMatrix, DVector};

/// Pivots below this share of their diagonal entry are rounding.
const DEPENDENT: f64 = 1e-12;

/// The factor of a symmetric, positive definite matrix of a size up to its own.
pub(crate) struct Cholesky {
    /// In the lower triangle.
    factor: DMatrix<f64>,
    size: usize,
}

impl Cholesky {
    /// Room for matrices of up to `n` by `n`.
    pub(crate) fn new(n: usize) -> Self {
        Self { factor: DMatrix::zeros(n, n), size: 0 }
    }

    /// Becomes the factor of the first `size` rows and columns of `matrix`, of which it reads the
    /// lower triangle.
    ///
    /// # Errors
    /// The first row that depends on those before it.
    pub(crate) fn set(&mut self, matrix: &DMatrix<f64>, size: usize) -> Result<(), usize> {
        self.size = size;
        for column in 0..size {
            for row in column..size {
                let known: f64 =
                    (0..column).map(|k| self.factor[(row, k)] * self.factor[(column, k)]).sum();
                let rest = matrix[(row, column)] - known;
                if row > column {
                    self.factor[(row, column)] = rest / self.factor[(column, column)];
                } else if rest > DEPENDENT * matrix[(row, row)] {
                    self.factor[(row, row)] = rest.sqrt();
                } else {
                    return Err(row);
                }
            }
        }
        Ok(())
    }

    /// Solves `matrix x = right`, both in the first entries of `x`.
    pub(crate) fn solve(&self, x: &mut DVector<f64>) {
        for row in 0..self.size {
            let known: f64 = (0..row).map(|k| self.factor[(row, k)] * x[k]).sum();
            x[row] = (x[row] - known) / self.factor[(row, row)];
        }
        for row in (0..self.size).rev() {
            let known: f64 = (row + 1..self.size).map(|k| self.factor[(k, row)] * x[k]).sum();
            x[row] = (x[row] - known) / self.factor[(row, row)];
        }
    }
}
