//! The normal equations of one step: what both solvers start from.

use crate::IkConfig;
use crate::cholesky::Cholesky;
use crate::linearised::Linearised;
use nalgebra::{DMatrix, DVector};

/// `hessian dq = pull`, the minimum of `|J dq - e|^2 + damping |dq|^2 + posture |dq -
/// to_posture|^2` without limits. The damping grows with the error, which keeps far targets
/// from throwing the arm about (Sugihara 2011).
pub(crate) struct Normal {
    damping: f64,
    posture: f64,
    pub(crate) hessian: DMatrix<f64>,
    pub(crate) pull: DVector<f64>,
    factor: Cholesky,
}

impl Normal {
    pub(crate) fn new(config: &IkConfig, joints: usize) -> Self {
        Self {
            damping: config.damping,
            posture: config.posture,
            hessian: DMatrix::zeros(joints, joints),
            pull: DVector::zeros(joints),
            factor: Cholesky::new(joints),
        }
    }

    /// Becomes the equations of a problem.
    pub(crate) fn set(&mut self, problem: &Linearised) {
        let damping = self.damping + 1e-3 * problem.error.norm_squared();
        self.hessian.gemm_tr(1.0, &problem.jacobian, &problem.jacobian, 0.0);
        for i in 0..self.pull.len() {
            self.hessian[(i, i)] += damping + self.posture;
        }
        self.pull.gemv_tr(1.0, &problem.jacobian, &problem.error, 0.0);
        self.pull.axpy(self.posture, &problem.to_posture, 1.0);
    }

    /// Solves them into `step` and says whether the Hessian is definite enough for that.
    pub(crate) fn solve(&mut self, step: &mut DVector<f64>) -> bool {
        if self.factor.set(&self.hessian, step.len()).is_err() {
            return false;
        }
        step.copy_from(&self.pull);
        self.factor.solve(step);
        true
    }
}
