//! The step as a quadratic program.

use crate::IkConfig;
use crate::descent::Step;
use crate::linearised::Linearised;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, SolverStatus, SupportedConeT::NonnegativeConeT,
};
use nalgebra::{DMatrix, DVector};

/// The objective's scale. The solver stops on an absolute gap of 1e-8; near the answer
/// the objective itself is smaller than that, and without this factor it says `Solved`
/// with steps that are wrong by up to 0.3 rad.
const SCALE: f64 = 1e6;

/// Steps that minimise `|J dq - e|^2 + damping |dq|^2 + posture |dq - to_posture|^2`
/// within the joint and step limits, by an interior-point method (clarabel).
pub(crate) struct QuadraticProgram {
    damping: f64,
    posture: f64,
}

impl Step for QuadraticProgram {
    fn new(config: &IkConfig) -> Self {
        Self { damping: config.damping, posture: config.posture }
    }

    fn step(&self, problem: &Linearised) -> Option<DVector<f64>> {
        let joints = problem.jacobian.ncols();
        let transposed = problem.jacobian.transpose();
        // Damping that grows with the error keeps far targets from throwing the arm about
        // (Sugihara 2011).
        let damping = self.damping + 1e-3 * problem.error.norm_squared();
        let mut hessian = DMatrix::identity(joints, joints) * (damping + self.posture);
        hessian += &transposed * &problem.jacobian;
        let gradient = -(transposed * problem.error) - &problem.to_posture * self.posture;
        let bounds: Vec<f64> =
            problem.upper.iter().copied().chain(problem.lower.iter().map(|v| -v)).collect();
        let settings = DefaultSettings { verbose: false, ..DefaultSettings::default() };
        let mut solver = DefaultSolver::new(
            &upper_triangle(&(hessian * SCALE)),
            (gradient * SCALE).as_slice(),
            &box_rows(joints),
            &bounds,
            &[NonnegativeConeT(2 * joints)],
            settings,
        )
        .ok()?;
        solver.solve();
        let solved =
            matches!(solver.solution.status, SolverStatus::Solved | SolverStatus::AlmostSolved);
        let step = DVector::from_column_slice(&solver.solution.x);
        (solved && step.iter().all(|v| v.is_finite())).then_some(step)
    }
}

/// The upper triangle of a symmetric matrix, column by column.
fn upper_triangle(matrix: &DMatrix<f64>) -> CscMatrix<f64> {
    let n = matrix.ncols();
    let mut starts = vec![0];
    let (mut rows, mut values) = (Vec::new(), Vec::new());
    for column in 0..n {
        rows.extend(0..=column);
        values.extend((0..=column).map(|row| matrix[(row, column)]));
        starts.push(rows.len());
    }
    CscMatrix::new(n, n, starts, rows, values)
}

/// The rows of `dq <= upper` and `-dq <= -lower`.
fn box_rows(n: usize) -> CscMatrix<f64> {
    let starts = (0..=n).map(|column| 2 * column).collect();
    let rows = (0..n).flat_map(|column| [column, n + column]).collect();
    CscMatrix::new(2 * n, n, starts, rows, [1.0, -1.0].repeat(n))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix6xX, Vector6};

    fn problem(limit: f64) -> Linearised {
        Linearised {
            jacobian: Matrix6xX::from_fn(6, |row, column| f64::from(u8::from(row == column))),
            error: Vector6::new(0.1, -0.2, 0.0, 0.0, 0.0, 0.05),
            lower: DVector::repeat(6, -limit),
            upper: DVector::repeat(6, limit),
            to_posture: DVector::zeros(6),
        }
    }

    #[test]
    fn the_step_is_exact_inside_and_stays_at_the_limits() {
        let program = QuadraticProgram { damping: 1e-9, posture: 0.0 };
        let free = program.step(&problem(1.0)).expect("a step");
        assert!(
            (&free - DVector::from_column_slice(&[0.1, -0.2, 0.0, 0.0, 0.0, 0.05])).norm() < 1e-4
        );
        let bound = program.step(&problem(0.1)).expect("a step");
        assert!((bound[1] + 0.1).abs() < 1e-4 && bound.amax() < 0.1 + 1e-6, "{bound}");
    }
}
