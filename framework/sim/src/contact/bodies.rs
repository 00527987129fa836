//! Contact of a shell with the rigid bodies at rest around it.

use super::resolve::push_out;
use super::{Body, Probes, Sample};
use crate::shell::{Momentum, Shell};
use crate::world::FRAME_S;
use nalgebra::Point3;

/// How far a point may come within a frame beyond what its speed tells, metres: gravity, a
/// hand that starts and what the shell's own constraints do.
const MARGIN_M: f64 = 0.02;

/// The bodies, and what of the shell each of them may touch within a frame.
#[derive(Clone, Debug)]
pub struct Bodies {
    bodies: Vec<(Body, Near)>,
    /// Points between the vertices.
    between: Vec<Sample>,
}

/// What may come into touch with one body.
#[derive(Clone, Debug, Default)]
struct Near {
    vertices: Vec<usize>,
    between: Vec<Sample>,
}

impl Bodies {
    /// `bodies` that may touch any of a shell's `samples`.
    pub fn new(bodies: Vec<Body>, samples: &[Sample]) -> Self {
        let between = samples.iter().filter(|s| !s.is_vertex()).copied().collect();
        Self { bodies: bodies.into_iter().map(|b| (b, Near::default())).collect(), between }
    }

    /// Collects what each body may touch in the next frame.
    pub fn begin_frame(&mut self, shell: &Shell) {
        let fastest = shell.velocity.iter().map(|v| v.norm_squared()).fold(0.0, f64::max).sqrt();
        let reach = MARGIN_M + fastest * FRAME_S;
        for (body, near) in &mut self.bodies {
            near.vertices.clear();
            near.between.clear();
            let close = |p: &Point3<f64>| body.may_reach(p, reach);
            near.vertices.extend((0..shell.position.len()).filter(|v| close(&shell.position[*v])));
            if body.probes == Probes::Samples && !near.vertices.is_empty() {
                let between = self.between.iter().filter(|s| close(&s.at(&shell.position)));
                near.between.extend(between);
            }
        }
    }

    /// Pushes the shell off the bodies, one after the other, in a substep of `h` seconds.
    /// Adds what they gave the shell to `given`, and tells what their rolling resistance may
    /// take from its spin, N m s.
    pub fn solve(&self, shell: &mut Shell, h: f64, given: &mut Momentum) -> f64 {
        let mut rolling = 0.0;
        for (body, near) in &self.bodies {
            let before = given.linear;
            let vertices = near.vertices.iter().copied();
            push_out(shell, vertices, |p| body.touch(p), body.friction, h, given);
            for sample in &near.between {
                with_sample(shell, sample, body, h, given);
            }
            rolling += (given.linear - before).norm() * body.rolling_arm_m();
        }
        rolling
    }
}

fn with_sample(shell: &mut Shell, sample: &Sample, body: &Body, h: f64, given: &mut Momentum) {
    let p = sample.at(&shell.position);
    let Some(touch) = body.touch(&p) else { return };
    let inverse = sample.inverse_mass(shell);
    if inverse <= 0.0 {
        return;
    }
    let (correction, _) = touch.correction(&(p - sample.at(&shell.previous)), body.friction, h);
    sample.shift(shell, &correction);
    for (v, weight) in sample.carriers().filter(|(v, _)| shell.inverse_mass[*v] > 0.0) {
        given.add(&(correction * (weight / (inverse * h))), &shell.position[v]);
    }
}

#[cfg(test)]
mod tests;
