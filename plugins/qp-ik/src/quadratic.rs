//! The step as a quadratic program.

use crate::IkConfig;
use crate::descent::Step;
use crate::linearised::Linearised;
use crate::normal::Normal;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT::NonnegativeConeT,
};
use nalgebra::DVector;

/// The objective's scale. The solver stops on an absolute gap of 1e-8; near the answer
/// the objective itself is smaller than that, and without this factor it says `Solved`
/// with steps that are wrong by up to 0.3 rad.
const SCALE: f64 = 1e6;

/// Steps that minimise `|J dq - e|^2 + damping |dq|^2 + posture |dq - to_posture|^2`
/// within the limits of joints, steps and distances. Where no limit is in the way that is the
/// answer of the normal equations; where one is, an interior-point method finds it (clarabel),
/// whose data are replaced for each step and whose memory is not.
pub(crate) struct QuadraticProgram {
    normal: Normal,
    interior: InteriorPoint,
}

/// The solver and the data that it is given, in its own order: of the Hessian the upper
/// triangle column by column, of the constraints for each column its upper bound, its lower
/// bound and its part in each pair.
struct InteriorPoint {
    solver: DefaultSolver<f64>,
    hessian: Vec<f64>,
    gradient: Vec<f64>,
    constraints: Vec<f64>,
    bounds: Vec<f64>,
}

impl Step for QuadraticProgram {
    fn new(config: &IkConfig, joints: usize, pairs: usize) -> Self {
        Self { normal: Normal::new(config, joints), interior: InteriorPoint::new(joints, pairs) }
    }

    fn step(&mut self, problem: &Linearised, step: &mut DVector<f64>) -> bool {
        self.normal.set(problem);
        (self.normal.solve(step) && problem.allows(step))
            || self.interior.solve(&self.normal, problem, step)
    }
}

impl InteriorPoint {
    fn new(joints: usize, pairs: usize) -> Self {
        let rows = 2 * joints + pairs;
        let (hessian, gradient) = (upper_triangle(joints), vec![0.0; joints]);
        let constraints = constraint_rows(joints, pairs);
        let bounds = vec![1.0; rows];
        let settings = DefaultSettings {
            verbose: false,
            // Data can be replaced only in a problem that nobody has reduced, and equilibration
            // would carry the scales of the first problem into all later ones, so that an
            // answer depended on the questions before it.
            presolve_enable: false,
            input_sparse_dropzeros: false,
            equilibrate_enable: false,
            ..DefaultSettings::default()
        };
        let solver = DefaultSolver::new(
            &hessian,
            &gradient,
            &constraints,
            &bounds,
            &[NonnegativeConeT(rows)],
            settings,
        )
        .expect("the sizes fit each other");
        Self { solver, hessian: hessian.nzval, gradient, constraints: constraints.nzval, bounds }
    }

    /// Solves `normal` within the problem's limits and says whether it did.
    fn solve(&mut self, normal: &Normal, problem: &Linearised, step: &mut DVector<f64>) -> bool {
        let (joints, pairs) = (step.len(), problem.room.len());
        let mut entry = 0;
        for column in 0..joints {
            for row in 0..=column {
                self.hessian[entry] = SCALE * normal.hessian[(row, column)];
                entry += 1;
            }
            self.gradient[column] = -SCALE * normal.pull[column];
            self.bounds[column] = problem.upper[column];
            self.bounds[joints + column] = -problem.lower[column];
            let parts = column * (2 + pairs) + 2;
            for pair in 0..pairs {
                self.constraints[parts + pair] = problem.approach[(pair, column)];
            }
        }
        self.bounds[2 * joints..].copy_from_slice(problem.room.as_slice());
        let data = (&self.hessian, &self.gradient, &self.constraints, &self.bounds);
        if self.solver.update_data(data.0, data.1, data.2, data.3).is_err() {
            return false;
        }
        self.solver.solve();
        let solution = &self.solver.solution;
        step.copy_from_slice(&solution.x);
        matches!(solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved)
            && step.iter().all(|v| v.is_finite())
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

/// The rows of `dq <= upper`, `-dq <= -lower` and `approach dq <= room`.
fn constraint_rows(n: usize, pairs: usize) -> CscMatrix<f64> {
    let starts = (0..=n).map(|column| (2 + pairs) * column).collect();
    let rows = (0..n).flat_map(|c| [c, n + c].into_iter().chain(2 * n..2 * n + pairs)).collect();
    let column = [1.0, -1.0].into_iter().chain(std::iter::repeat_n(0.0, pairs));
    let values = (0..n).flat_map(|_| column.clone()).collect();
    CscMatrix::new(2 * n + pairs, n, starts, rows, values)
}
