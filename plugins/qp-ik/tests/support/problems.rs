//! Steps of a UR5 near its singularities as quadratic programs of 6 unknowns and 24 rows.

use nalgebra::{DMatrix, DVector};
use rand::Rng;
use seeone_core::random::{direction, uniform};
use seeone_core::robot::{RobotModel, RobotOptions};
use seeone_qp_ik::Problem;
use std::path::Path;

/// The damping of the shipped configuration, square metres a square radian.
const DAMPING: f64 = 1e-6;
/// Weight of a radian in metres.
const RADIAN_M: f64 = 0.25;
/// Rows beside those of the joints.
const ROWS: usize = 12;

/// A problem's numbers.
pub struct Owned {
    hessian: DMatrix<f64>,
    pull: DVector<f64>,
    lower: DVector<f64>,
    upper: DVector<f64>,
    rows: DMatrix<f64>,
    bounds: DVector<f64>,
}

impl Owned {
    /// The problem.
    pub fn problem(&self) -> Problem<'_> {
        let Self { hessian, pull, lower, upper, rows, bounds } = self;
        Problem { hessian, pull, lower, upper, rows, bounds }
    }
}

/// The shipped arm.
pub fn ur5() -> RobotModel {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/ur5-ag95.urdf");
    RobotModel::from_urdf(&file, &RobotOptions::default()).expect("the shipped robot")
}

/// A step at most 1e-1 rad from wrist or elbow singularity, towards a target 0.01 to 30 mm away;
/// joints and up to three near pairs hold it up.
pub fn near_singular(robot: &RobotModel, rng: &mut impl Rng) -> Owned {
    let mut q: Vec<f64> = (0..6).map(|_| uniform(rng, -3.0, 3.0)).collect();
    let joint = if uniform(rng, 0.0, 1.0) < 0.5 { 4 } else { 2 };
    q[joint] = 10f64.powf(uniform(rng, -5.0, -1.0));
    let mut jacobian = robot.jacobian(&q);
    jacobian.rows_mut(3, 3).scale_mut(RADIAN_M);
    let far = 10f64.powf(uniform(rng, -5.0, -1.5));
    let (linear, angular) = (direction(rng) * far, direction(rng) * far);
    let error = DVector::from_iterator(6, linear.iter().chain(angular.iter()).copied());
    let jacobian = DMatrix::from_column_slice(6, 6, jacobian.as_slice());
    let damping = DAMPING + 1e-3 * error.norm_squared();
    let free = far * 10f64.powf(uniform(rng, -0.5, 2.0));
    let mut rows = DMatrix::zeros(ROWS, 6);
    let mut bounds = DVector::repeat(ROWS, 1.0);
    for row in 0..3 {
        rows.row_mut(row).iter_mut().for_each(|v| *v = uniform(rng, -0.8, 0.8));
        bounds[row] = far * uniform(rng, 0.0, 2.0);
    }
    Owned {
        hessian: jacobian.tr_mul(&jacobian) + DMatrix::identity(6, 6) * damping,
        pull: jacobian.tr_mul(&error),
        lower: DVector::from_fn(6, |_, _| -uniform(rng, 0.05, 1.0) * free),
        upper: DVector::from_fn(6, |_, _| uniform(rng, 0.05, 1.0) * free),
        rows,
        bounds,
    }
}
