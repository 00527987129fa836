//! The step by damped least squares.

use crate::IkConfig;
use crate::descent::Step;
use crate::linearised::Linearised;
use nalgebra::{DVector, Matrix6};

/// Steps `J^T (J J^T + damping I)^-1 e`, shortened to the limits (Wampler 1986).
pub(crate) struct Damped {
    damping: f64,
}

impl Step for Damped {
    fn new(config: &IkConfig) -> Self {
        Self { damping: config.damping }
    }

    fn step(&self, problem: &Linearised) -> Option<DVector<f64>> {
        let damping = self.damping + 1e-3 * problem.error.norm_squared();
        let transposed = problem.jacobian.transpose();
        let gram: Matrix6<f64> = &problem.jacobian * &transposed + Matrix6::identity() * damping;
        let step = transposed * gram.cholesky()?.solve(&problem.error);
        Some(step.zip_zip_map(&problem.lower, &problem.upper, f64::clamp))
    }
}
