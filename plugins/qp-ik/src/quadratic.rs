//! The step as a quadratic program.

use crate::descent::Step;
use crate::linearised::Linearised;
use crate::normal::Normal;
use crate::program::QuadraticProgram;
use crate::{IkConfig, Problem};
use nalgebra::DVector;

/// Further away than this the linearised problem says so little about the true one that its exact
/// answer is not worth the time: the step without limits, cut to them, arrives as often.
/// Metres, a radian weighed as in [`Linearised`].
const FAR_M: f64 = 0.02;

/// Steps that minimise `|J dq - e|^2 + damping |dq|^2 + posture |dq - to_posture|^2`
/// within the limits of joints, steps and distances. Where no limit is in the way that is the
/// answer of the normal equations, fifty times as fast; where one is, of a quadratic program.
pub(crate) struct Quadratic {
    normal: Normal,
    program: QuadraticProgram,
}

impl Step for Quadratic {
    fn new(config: &IkConfig, joints: usize, pairs: usize) -> Self {
        let program = QuadraticProgram::new(joints, pairs);
        Self { normal: Normal::new(config, joints), program }
    }

    fn step(&mut self, problem: &Linearised, step: &mut DVector<f64>) -> bool {
        self.normal.set(problem);
        if self.normal.solve(step) && problem.allows(step) {
            return true;
        }
        if problem.error.norm() > FAR_M {
            step.zip_zip_apply(&problem.lower, &problem.upper, |d, low, high| {
                *d = d.clamp(low, high);
            });
            if problem.allows(step) {
                return true;
            }
        }
        let problem = Problem {
            hessian: &self.normal.hessian,
            pull: &self.normal.pull,
            lower: &problem.lower,
            upper: &problem.upper,
            rows: &problem.approach,
            bounds: &problem.room,
        };
        self.program.solve(&problem, step)
    }
}
