//! From an answer that is nearly right to the exact one.

use crate::Problem;
use crate::cholesky::Cholesky;
use nalgebra::{DMatrix, DVector};

/// Rounds in which a row may join those that hold or leave them.
const ROUNDS: usize = 30;
/// Rows may be broken by so much of the largest bound of a joint: rounding.
const ROUNDING: f64 = 1e-10;

/// Which rows hold with equality, and the minimum on those. What it accepts satisfies the
/// conditions of Karush, Kuhn and Tucker, which in a strictly convex program only the minimum does.
pub(crate) struct Finish {
    hessian: Cholesky,
    /// `A H^-1 A^T` of the rows that hold.
    across: DMatrix<f64>,
    factor: Cholesky,
    /// A column of `H^-1 A^T` for each of them.
    towards: Vec<DVector<f64>>,
    free: DVector<f64>,
    forces: DVector<f64>,
    holding: Vec<usize>,
}

impl Finish {
    /// For programs of `n` unknowns.
    pub(crate) fn new(n: usize) -> Self {
        Self {
            hessian: Cholesky::new(n),
            across: DMatrix::zeros(n, n),
            factor: Cholesky::new(n),
            towards: vec![DVector::zeros(n); n],
            free: DVector::zeros(n),
            forces: DVector::zeros(n),
            holding: Vec::with_capacity(n + 1),
        }
    }

    /// Puts the minimum into `x` and says whether it was found, `likely` naming the rows that
    /// probably hold with equality there.
    pub(crate) fn minimum(
        &mut self,
        problem: &Problem,
        likely: impl Iterator<Item = usize>,
        x: &mut DVector<f64>,
    ) -> bool {
        let n = x.len();
        if self.hessian.set(problem.hessian, n).is_err() {
            return false;
        }
        self.free.copy_from(problem.pull);
        self.hessian.solve(&mut self.free);
        self.holding.clear();
        self.holding.extend(likely.take(n));
        let rounding = ROUNDING * problem.longest();
        for _ in 0..ROUNDS {
            self.hold(problem, x);
            let forces = self.forces.iter().take(self.holding.len());
            let pulling = forces.enumerate().min_by(|a, b| a.1.total_cmp(b.1));
            if let Some((index, force)) = pulling
                && *force < 0.0
            {
                self.holding.swap_remove(index);
                continue;
            }
            let broken = |row: usize| problem.along(row, x) - problem.bound(row);
            let others = (0..problem.rows()).filter(|row| !self.holding.contains(row));
            let worst = others.map(|row| (row, broken(row))).max_by(|a, b| a.1.total_cmp(&b.1));
            match worst {
                Some((row, by)) if by > rounding => {
                    if self.holding.len() == n {
                        return false;
                    }
                    self.holding.push(row);
                }
                _ => return x.iter().all(|v| v.is_finite()),
            }
        }
        false
    }

    /// Puts the minimum with the holding rows as equations into `x`; those that depend on others
    /// hold no longer.
    fn hold(&mut self, problem: &Problem, x: &mut DVector<f64>) {
        loop {
            for (index, row) in self.holding.iter().enumerate() {
                let towards = &mut self.towards[index];
                for column in 0..towards.len() {
                    towards[column] = problem.entry(*row, column);
                }
                self.hessian.solve(towards);
                self.forces[index] = problem.along(*row, &self.free) - problem.bound(*row);
                for (other, row) in self.holding.iter().enumerate().skip(index) {
                    self.across[(other, index)] = problem.along(*row, &self.towards[index]);
                }
            }
            match self.factor.set(&self.across, self.holding.len()) {
                Ok(()) => break,
                Err(row) => _ = self.holding.remove(row),
            }
        }
        self.factor.solve(&mut self.forces);
        x.copy_from(&self.free);
        for (towards, force) in self.towards.iter().zip(&self.forces).take(self.holding.len()) {
            x.axpy(-force, towards, 1.0);
        }
    }
}
