//! The step by damped least squares.

use crate::IkConfig;
use crate::descent::Step;
use crate::linearised::Linearised;
use crate::normal::Normal;
use nalgebra::DVector;

/// Steps `(J^T J + damping I)^-1 J^T e`, shortened to the limits (Wampler 1986). Of what is
/// near it knows nothing.
pub(crate) struct Damped(Normal);

impl Step for Damped {
    fn new(config: &IkConfig, joints: usize, _pairs: usize) -> Self {
        Self(Normal::new(config, joints))
    }

    fn step(&mut self, problem: &Linearised, step: &mut DVector<f64>) -> bool {
        self.0.set(problem);
        let solved = self.0.solve(step);
        step.zip_zip_apply(&problem.lower, &problem.upper, |d, low, high| *d = d.clamp(low, high));
        solved
    }
}
