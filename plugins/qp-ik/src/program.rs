//! One small quadratic program after another, in the same memory.

use crate::Problem;
use crate::finish::Finish;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT::NonnegativeConeT,
};
use nalgebra::DVector;

/// The objective's scale: its steepest slope times the longest step. The solver stops on an
/// absolute gap, and near the answer the objective itself is smaller than any; without scale it
/// says `Solved` with steps that are wrong by up to 0.3 rad.
const SCALE: f64 = 1e2;
/// The gap at which the solver stops, and by how much rows may be broken then: near enough that
/// few are wrongly taken to hold or not to, and, where the exact answer is not found from there, as
/// near as it comes.
const TOLERANCES: [(f64, f64); 2] = [(1e-2, 1e-4), (1e-8, 1e-8)];

/// Solves problems of one size. An interior-point method (clarabel), whose data are replaced for
/// each and whose memory is not, comes near the answer and tells which rows hold there; the
/// equations of those give it exactly. No answer depends on the problems before it.
pub struct QuadraticProgram {
    /// One for each of [`TOLERANCES`].
    solvers: [DefaultSolver<f64>; 2],
    /// The upper triangle, column by column.
    hessian: Vec<f64>,
    gradient: Vec<f64>,
    /// For each column its upper bound, its lower bound, and its part in each row.
    constraints: Vec<f64>,
    bounds: Vec<f64>,
    finish: Finish,
}

impl QuadraticProgram {
    /// For problems of `n` unknowns and `m` rows.
    ///
    /// # Panics
    /// When `n` is zero.
    pub fn new(n: usize, m: usize) -> Self {
        let (hessian, gradient) = (upper_triangle(n), vec![0.0; n]);
        let constraints = constraint_rows(n, m);
        let bounds = vec![1.0; 2 * n + m];
        let solvers = TOLERANCES.map(|(gap, broken)| {
            let cones = [NonnegativeConeT(bounds.len())];
            let settings = settings(gap, broken);
            let solver =
                DefaultSolver::new(&hessian, &gradient, &constraints, &bounds, &cones, settings);
            let mut solver = solver.expect("the sizes fit each other");
            // Every solve empties the solver's own table of timers, which would allocate it anew;
            // the tables below a timer that never ends stay.
            solver.timers.iter_mut().for_each(|timers| timers.start_as_current("programs"));
            solver
        });
        let (hessian, constraints) = (hessian.nzval, constraints.nzval);
        Self { solvers, hessian, gradient, constraints, bounds, finish: Finish::new(n) }
    }

    /// Puts the minimum into `x` and says whether it was found.
    ///
    /// # Panics
    /// When the problem is of another size.
    pub fn solve(&mut self, problem: &Problem, x: &mut DVector<f64>) -> bool {
        let (n, m) = (problem.pull.len(), problem.bounds.len());
        assert_eq!((n, 2 * n + m), (self.gradient.len(), self.bounds.len()), "another size");
        let longest = problem.longest();
        if longest == 0.0 {
            // No joint may move.
            x.fill(0.0);
            return true;
        }
        self.set(problem, longest);
        for solver in &mut self.solvers {
            let data = (&self.hessian, &self.gradient, &self.constraints, &self.bounds);
            if solver.update_data(data.0, data.1, data.2, data.3).is_err() {
                return false;
            }
            solver.solve();
            let solution = &solver.solution;
            if !matches!(solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved) {
                return false;
            }
            let holds = |row: &usize| solution.z[*row] > solution.s[*row];
            if self.finish.minimum(problem, (0..problem.rows()).filter(holds), x) {
                return true;
            }
            x.iter_mut().zip(&solution.x).for_each(|(x, found)| *x = longest * found);
        }
        x.iter().all(|v| v.is_finite())
    }

    /// Takes the numbers of a problem, steps in units of the longest, the objective in those of its
    /// slope.
    fn set(&mut self, problem: &Problem, longest: f64) {
        let (n, m) = (problem.pull.len(), problem.bounds.len());
        let steepest = problem.pull.amax();
        let slope = if steepest > 0.0 { SCALE / steepest } else { SCALE };
        let mut entry = 0;
        for column in 0..n {
            for row in 0..=column {
                self.hessian[entry] = slope * longest * problem.hessian[(row, column)];
                entry += 1;
            }
            self.gradient[column] = -slope * problem.pull[column];
            let parts = column * (2 + m) + 2;
            for row in 0..m {
                self.constraints[parts + row] = problem.rows[(row, column)];
            }
        }
        for row in 0..problem.rows() {
            self.bounds[row] = problem.bound(row) / longest;
        }
    }
}

/// The settings of a solver that stops at this gap and lets rows be broken by so much.
fn settings(gap: f64, broken: f64) -> DefaultSettings<f64> {
    DefaultSettings {
        verbose: false,
        tol_gap_abs: gap,
        tol_gap_rel: gap,
        tol_feas: broken,
        // Data can be replaced only in a problem that nobody has reduced, and equilibration
        // would carry the scales of the first problem into all later ones, so that an
        // answer depended on the questions before it.
        presolve_enable: false,
        input_sparse_dropzeros: false,
        equilibrate_enable: false,
        // Of the time it took two fifths, and of the error nothing.
        iterative_refinement_enable: false,
        ..DefaultSettings::default()
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
