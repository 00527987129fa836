//! From paths to trajectories: each piece starts and ends at rest, follows a quintic in
//! time (no step in acceleration), and takes as long as the limits demand.

use crate::MotionConfig;
use seeone_core::robot::RobotModel;
use seeone_plugin::JointTrajectory;

/// The quintic's largest speed and acceleration for unit length in unit time.
const PEAK_SPEED: f64 = 1.875;

/// Times paths for one robot.
pub(crate) struct Timing<'a> {
    pub(crate) robot: &'a RobotModel,
    pub(crate) config: &'a MotionConfig,
}

impl Timing<'_> {
    /// A path of straight lines in joint space, at rest at every corner, the tool no
    /// faster than `tool_speed` (m/s).
    pub(crate) fn corners(&self, path: &[Vec<f64>], tool_speed: f64) -> JointTrajectory {
        let mut samples = path[..1].to_vec();
        for pair in path.windows(2) {
            let at = |u: f64| mix(&pair[0], &pair[1], u);
            self.append(&mut samples, &at, tool_speed);
        }
        JointTrajectory { period_s: self.config.period_s, positions: samples }
    }

    /// A line of closely spaced postures at equal distances, run through smoothly; pieces
    /// are `(postures, tool speed)`, each beginning where the one before ends.
    pub(crate) fn line(&self, pieces: &[(&[Vec<f64>], f64)]) -> JointTrajectory {
        let mut samples = pieces[0].0[..1].to_vec();
        for (path, tool_speed) in pieces {
            self.append(&mut samples, &|u: f64| spline(path, u), *tool_speed);
        }
        JointTrajectory { period_s: self.config.period_s, positions: samples }
    }

    /// Appends the samples of one piece, whose first posture is already there.
    fn append(&self, samples: &mut Vec<Vec<f64>>, at: &dyn Fn(f64) -> Vec<f64>, tool_speed: f64) {
        let period = self.config.period_s;
        let mut duration: f64 = self.shortest(at, tool_speed).max(period);
        loop {
            let count = (duration / period).ceil().max(1.0) as usize;
            let piece: Vec<Vec<f64>> =
                (0..=count).map(|k| at(quintic(k as f64 / count as f64))).collect();
            let excess = self.excess(&piece, tool_speed);
            if excess <= 1.0 {
                samples.extend(piece.into_iter().skip(1));
                return;
            }
            // At least a whole period more, so that this ends.
            duration = count as f64 * period * excess + period;
        }
    }

    /// A lower bound of a piece's duration from its chord.
    fn shortest(&self, at: &dyn Fn(f64) -> Vec<f64>, tool_speed: f64) -> f64 {
        let (a, b) = (at(0.0), at(1.0));
        let joints = self.robot.joints().iter().zip(a.iter().zip(&b));
        let speed = |(joint, (a, b)): (&seeone_core::robot::Joint, (&f64, &f64))| {
            PEAK_SPEED * (a - b).abs() / (joint.velocity() * self.config.speed)
        };
        let tool = self.tool(&a).metric_distance(&self.tool(&b));
        joints.map(speed).fold(PEAK_SPEED * tool / tool_speed, f64::max)
    }

    /// By what factor the samples are too fast: the largest speed over its limit, or the
    /// root of the largest acceleration over its limit.
    fn excess(&self, samples: &[Vec<f64>], tool_speed: f64) -> f64 {
        let period = self.config.period_s;
        let mut excess: f64 = 0.0;
        for (i, joint) in self.robot.joints().iter().enumerate() {
            let mut before = 0.0;
            let steps = samples.windows(2).map(|pair| (pair[1][i] - pair[0][i]) / period);
            // The arm rests before the first and after the last sample.
            for speed in steps.chain([0.0]) {
                let acceleration = (speed - before).abs() / period;
                excess = excess
                    .max(speed.abs() / (joint.velocity() * self.config.speed))
                    .max((acceleration / self.robot.acceleration()).sqrt());
                before = speed;
            }
        }
        let tips: Vec<_> = samples.iter().map(|q| self.tool(q)).collect();
        let fastest =
            tips.windows(2).map(|pair| pair[0].metric_distance(&pair[1])).fold(0.0, f64::max);
        excess.max(fastest / period / tool_speed)
    }

    fn tool(&self, q: &[f64]) -> nalgebra::Vector3<f64> {
        self.robot.tool_pose(q).translation.vector
    }
}

/// From 0 to 1 with speed and acceleration zero at both ends.
fn quintic(u: f64) -> f64 {
    u * u * u * (10.0 + u * (6.0 * u - 15.0))
}

fn mix(a: &[f64], b: &[f64], u: f64) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + u * (b - a)).collect()
}

/// The Catmull-Rom spline through equally spaced postures at `u` in 0..=1.
fn spline(path: &[Vec<f64>], u: f64) -> Vec<f64> {
    let last = path.len() - 1;
    if last == 0 {
        return path[0].clone();
    }
    let at = (u * last as f64).clamp(0.0, last as f64);
    let k = (at.floor() as usize).min(last - 1);
    let t = at - k as f64;
    let (a, b) = (&path[k], &path[k + 1]);
    (0..a.len())
        .map(|i| {
            // Beyond an end the path goes on straight.
            let before = if k > 0 { path[k - 1][i] } else { 2.0 * a[i] - b[i] };
            let after = if k + 2 <= last { path[k + 2][i] } else { 2.0 * b[i] - a[i] };
            let (leaving, arriving) = (0.5 * (b[i] - before), 0.5 * (after - a[i]));
            let (t2, t3) = (t * t, t * t * t);
            a[i] * (2.0 * t3 - 3.0 * t2 + 1.0)
                + leaving * (t3 - 2.0 * t2 + t)
                + b[i] * (3.0 * t2 - 2.0 * t3)
                + arriving * (t3 - t2)
        })
        .collect()
}
