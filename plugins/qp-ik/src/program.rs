//! One small quadratic program after another, in the same memory.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT::NonnegativeConeT,
};
use nalgebra::{DMatrix, DVector};

/// The objective's scale. The solver stops on an absolute gap of 1e-8; near the answer
/// the objective itself is smaller than that, and without this factor it says `Solved`
/// with steps that are wrong by up to 0.3 rad.
const SCALE: f64 = 1e6;

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

/// Solves problems of one size by an interior-point method (clarabel), whose data are replaced
/// for each and whose memory is not. No answer depends on the problems before it.
pub struct QuadraticProgram {
    solver: DefaultSolver<f64>,
    /// The upper triangle, column by column.
    hessian: Vec<f64>,
    gradient: Vec<f64>,
    /// For each column its upper bound, its lower bound, and its part in each row.
    constraints: Vec<f64>,
    bounds: Vec<f64>,
}

impl QuadraticProgram {
    /// For problems of `n` unknowns and `m` rows.
    ///
    /// # Panics
    /// When `n` is zero.
    pub fn new(n: usize, m: usize) -> Self {
        let rows = 2 * n + m;
        let (hessian, gradient) = (upper_triangle(n), vec![0.0; n]);
        let constraints = constraint_rows(n, m);
        let bounds = vec![1.0; rows];
        let settings = DefaultSettings {
            verbose: false,
            // Data can be replaced only in a problem that nobody has reduced, and equilibration
            // would carry the scales of the first problem into all later ones, so that an
            // answer depended on the questions before it.
            presolve_enable: false,
            input_sparse_dropzeros: false,
            equilibrate_enable: false,
            // Of the time it took two fifths, and of the error nothing.
            iterative_refinement_enable: false,
            ..DefaultSettings::default()
        };
        let mut solver = DefaultSolver::new(
            &hessian,
            &gradient,
            &constraints,
            &bounds,
            &[NonnegativeConeT(rows)],
            settings,
        )
        .expect("the sizes fit each other");
        // Every solve empties the solver's own table of timers, which would allocate it anew; the
        // tables below a timer that never ends stay.
        solver.timers.iter_mut().for_each(|timers| timers.start_as_current("programs"));
        Self { solver, hessian: hessian.nzval, gradient, constraints: constraints.nzval, bounds }
    }

    /// Puts the minimum into `x` and says whether it was found.
    ///
    /// # Panics
    /// When the problem is of another size.
    pub fn solve(&mut self, problem: &Problem, x: &mut DVector<f64>) -> bool {
        let (n, m) = (problem.pull.len(), problem.bounds.len());
        assert_eq!((n, 2 * n + m), (self.gradient.len(), self.bounds.len()), "another size");
        let mut entry = 0;
        for column in 0..n {
            for row in 0..=column {
                self.hessian[entry] = SCALE * problem.hessian[(row, column)];
                entry += 1;
            }
            self.gradient[column] = -SCALE * problem.pull[column];
            self.bounds[column] = problem.upper[column];
            self.bounds[n + column] = -problem.lower[column];
            let parts = column * (2 + m) + 2;
            for row in 0..m {
                self.constraints[parts + row] = problem.rows[(row, column)];
            }
        }
        self.bounds[2 * n..].copy_from_slice(problem.bounds.as_slice());
        let data = (&self.hessian, &self.gradient, &self.constraints, &self.bounds);
        if self.solver.update_data(data.0, data.1, data.2, data.3).is_err() {
            return false;
        }
        self.solver.solve();
        let solution = &self.solver.solution;
        x.copy_from_slice(&solution.x);
        matches!(solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved)
            && x.iter().all(|v| v.is_finite())
    }
}

/// The pattern of the upper triangle of a symmetric matrix, column by column, an identity.
fn upper_triangle(n: usize) -> CscMatrix<f64> {
    let mut starts = vec![0];
    let (mut rows, mut values) = (Vec::new(), Vec::new());
    for column in 0..n {
        rows.extend(0..=column);
        values.extend((0..=column).map(|row| if row == column { 1.0 } else { 0.0 }));
        starts.push(rows.len());
    }
    CscMatrix::new(n, n, starts, rows, values)
}

/// The pattern of `x <= upper`, `-x <= -lower` and `rows x <= bounds`.
fn constraint_rows(n: usize, m: usize) -> CscMatrix<f64> {
    let starts = (0..=n).map(|column| (2 + m) * column).collect();
    let rows = (0..n).flat_map(|c| [c, n + c].into_iter().chain(2 * n..2 * n + m)).collect();
    let column = [1.0, -1.0].into_iter().chain(std::iter::repeat_n(0.0, m));
    let values = (0..n).flat_map(|_| column.clone()).collect();
    CscMatrix::new(2 * n + m, n, starts, rows, values)
}
