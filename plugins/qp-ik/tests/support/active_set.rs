//! A quadratic program by the textbook's active-set method (Nocedal and Wright 2006, algorithm
//! 16.3): exact to rounding, and nothing that the solver shares.

use nalgebra::{DMatrix, DVector};
use seeone_qp_ik::Problem;

/// Steps shorter than this are none.
const STILL: f64 = 1e-12;

/// The minimum of a problem that zero is feasible for.
pub fn minimum(problem: &Problem) -> DVector<f64> {
    let (normals, bounds) = constraints(problem);
    let n = problem.pull.len();
    let mut x: DVector<f64> = DVector::zeros(n);
    let mut active: Vec<usize> = Vec::new();
    for _ in 0..500 {
        let (step, multipliers) = towards(problem, &normals, &x, &active);
        if step.amax() < STILL {
            let least = multipliers.iter().copied().enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
            match least {
                Some((index, multiplier)) if multiplier < 0.0 => _ = active.remove(index),
                _ => return x,
            }
            continue;
        }
        let blocking = (0..bounds.len())
            .filter(|row| !active.contains(row))
            .map(|row| (row, normals.row(row).tr_dot(&step), normals.row(row).tr_dot(&x)))
            .filter(|(_, rate, _)| *rate > 1e-14)
            .map(|(row, rate, at)| (row, ((bounds[row] - at) / rate).max(0.0)))
            .min_by(|a, b| a.1.total_cmp(&b.1));
        match blocking {
            Some((row, share)) if share < 1.0 => {
                x += step * share;
                active.push(row);
            }
            _ => x += step,
        }
    }
    panic!("the active set goes round in circles");
}

/// Every constraint as a row `normal x <= bound`.
fn constraints(problem: &Problem) -> (DMatrix<f64>, Vec<f64>) {
    let (n, m) = (problem.pull.len(), problem.bounds.len());
    let mut normals = DMatrix::zeros(2 * n + m, n);
    for i in 0..n {
        normals[(i, i)] = 1.0;
        normals[(n + i, i)] = -1.0;
    }
    normals.rows_mut(2 * n, m).copy_from(problem.rows);
    let upper = problem.upper.iter().copied();
    let bounds =
        upper.chain(problem.lower.iter().map(|v| -v)).chain(problem.bounds.iter().copied());
    (normals, bounds.collect())
}

/// The step to the minimum with the active constraints held, and their multipliers.
fn towards(
    problem: &Problem,
    normals: &DMatrix<f64>,
    x: &DVector<f64>,
    active: &[usize],
) -> (DVector<f64>, Vec<f64>) {
    let (n, k) = (x.len(), active.len());
    let mut system = DMatrix::zeros(n + k, n + k);
    system.view_mut((0, 0), (n, n)).copy_from(problem.hessian);
    for (i, row) in active.iter().enumerate() {
        system.view_mut((n + i, 0), (1, n)).copy_from(&normals.row(*row));
        system.view_mut((0, n + i), (n, 1)).copy_from(&normals.row(*row).transpose());
    }
    let mut right = DVector::zeros(n + k);
    right.rows_mut(0, n).copy_from(&(problem.pull - problem.hessian * x));
    let solution = system.full_piv_lu().solve(&right).expect("independent constraints");
    (solution.rows(0, n).into_owned(), solution.rows(n, k).iter().copied().collect())
}
