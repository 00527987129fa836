//! From paths to trajectories: each piece starts and ends at rest, is run through with limited
//! jerk, and takes as long as the limits demand.

use crate::MotionConfig;
use crate::profile::{Limits, Profile};
use crate::spline::Spline;
use nalgebra::Vector3;
use seeone_core::robot::RobotModel;
use seeone_plugin::JointTrajectory;

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
            let spline = Spline::through(path);
            self.append(&mut samples, &|u: f64| self.allowed(spline.at(u)), *tool_speed);
        }
        JointTrajectory { period_s: self.config.period_s, positions: samples }
    }

    /// Between two postures at a joint's limit a curve goes a little beyond it; the arm may not.
    fn allowed(&self, mut posture: Vec<f64>) -> Vec<f64> {
        for (q, joint) in posture.iter_mut().zip(self.robot.joints()) {
            *q = q.clamp(joint.lower(), joint.upper());
        }
        posture
    }

    /// Appends the samples of one piece, whose first posture is already there.
    fn append(&self, samples: &mut Vec<Vec<f64>>, at: &dyn Fn(f64) -> Vec<f64>, tool_speed: f64) {
        let period = self.config.period_s;
        let profile = Profile::fastest(&self.limits(at, tool_speed));
        let mut duration: f64 = profile.duration();
        loop {
            // A whole number of periods: the last sample is the end.
            let count = (duration / period).ceil().max(1.0) as usize;
            let piece: Vec<Vec<f64>> =
                (0..=count).map(|k| at(profile.at(k as f64 / count as f64).position)).collect();
            let excess = self.excess(&piece, tool_speed);
            if excess <= 1.0 {
                samples.extend(piece.into_iter().skip(1));
                return;
            }
            // At least a whole period more, so that this ends.
            duration = (count as f64 * period * excess).max(period * (count + 1) as f64);
        }
    }

    /// What a piece allows if it goes straight from end to end; all that is beyond comes out
    /// when its samples are looked at.
    fn limits(&self, at: &dyn Fn(f64) -> Vec<f64>, tool_speed: f64) -> Limits {
        let (a, b) = (at(0.0), at(1.0));
        let tool = self.tool(&a).metric_distance(&self.tool(&b));
        let most =
            |limit: f64, length: f64| if length > 0.0 { limit / length } else { f64::INFINITY };
        let mut limits = Limits {
            speed: most(tool_speed, tool),
            acceleration: most(self.config.tool_acceleration_m_s2, tool),
            jerk: f64::INFINITY,
        };
        for (joint, (a, b)) in self.robot.joints().iter().zip(a.iter().zip(&b)) {
            let length = (a - b).abs();
            limits.speed = limits.speed.min(most(joint.velocity() * self.config.speed, length));
            limits.acceleration = limits.acceleration.min(most(self.robot.acceleration(), length));
            limits.jerk = limits.jerk.min(most(self.robot.jerk(), length));
        }
        // A piece that ends where it begins bounds nothing; its samples will.
        let unbounded = 1.0 / self.config.period_s;
        Limits {
            speed: limits.speed.min(unbounded),
            acceleration: limits.acceleration.min(unbounded.powi(2)),
            jerk: limits.jerk.min(unbounded.powi(3)),
        }
    }

    /// By what factor the samples are too fast: the largest speed over its limit, the root of
    /// the largest acceleration over its limit, the cube root of the largest jerk over its.
    fn excess(&self, samples: &[Vec<f64>], tool_speed: f64) -> f64 {
        let period = self.config.period_s;
        let (acceleration, jerk) = (self.robot.acceleration(), self.robot.jerk());
        let mut excess: f64 = 0.0;
        for (i, joint) in self.robot.joints().iter().enumerate() {
            let most = joint.velocity() * self.config.speed;
            for [first, second, third] in differences(samples, i, period) {
                excess = excess
                    .max(first.abs() / most)
                    .max((second.abs() / acceleration).sqrt())
                    .max((third.abs() / jerk).cbrt());
            }
        }
        let tips: Vec<Vector3<f64>> = samples.iter().map(|q| self.tool(q)).collect();
        let mut before = Vector3::zeros();
        for pair in tips.windows(2) {
            let velocity = (pair[1] - pair[0]) / period;
            let change = (velocity - before).norm() / period;
            excess = excess
                .max(velocity.norm() / tool_speed)
                .max((change / self.config.tool_acceleration_m_s2).sqrt());
            before = velocity;
        }
        excess
    }

    fn tool(&self, q: &[f64]) -> Vector3<f64> {
        self.robot.tool_pose(q).translation.vector
    }
}

/// Speed, acceleration and jerk of joint `i` from sample to sample; before the first and after
/// the last it rests.
pub(crate) fn differences(
    samples: &[Vec<f64>],
    i: usize,
    period: f64,
) -> impl Iterator<Item = [f64; 3]> {
    let steps = samples.windows(2).map(move |pair| (pair[1][i] - pair[0][i]) / period);
    steps.chain([0.0, 0.0]).scan([0.0; 2], move |before, first| {
        let second = (first - before[0]) / period;
        let third = (second - before[1]) / period;
        *before = [first, second];
        Some([first, second, third])
    })
}

fn mix(a: &[f64], b: &[f64], u: f64) -> Vec<f64> {
    // Both ends exactly, and between them not a rounding further: they may lie at a limit.
    let between = |(a, b): (&f64, &f64)| ((1.0 - u) * a + u * b).clamp(a.min(*b), a.max(*b));
    a.iter().zip(b).map(between).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use seeone_core::random::{Generator, generator, uniform};
    use seeone_core::robot::RobotOptions;
    use std::path::Path;

    fn ur5(rng: &mut Generator) -> RobotModel {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/ur5-ag95.urdf");
        let options = RobotOptions {
            acceleration: uniform(rng, 1.0, 40.0),
            jerk: uniform(rng, 10.0, 2000.0),
            ..RobotOptions::default()
        };
        RobotModel::from_urdf(&file, &options).unwrap()
    }

    fn draw(robot: &RobotModel, rng: &mut Generator) -> Vec<f64> {
        robot.joints().iter().map(|j| uniform(rng, j.lower(), j.upper())).collect()
    }

    /// A line as the planner has them: near postures that go the same way, bending a little.
    fn bent(robot: &RobotModel, rng: &mut Generator) -> Vec<Vec<f64>> {
        let (start, count) = (draw(robot, rng), 5 + (uniform(rng, 0.0, 40.0) as usize));
        let mut ways = || -> Vec<f64> { (0..6).map(|_| uniform(rng, -0.01, 0.01)).collect() };
        let (way, bend) = (ways(), ways());
        let posture = |k: usize| {
            let joints = robot.joints().iter().enumerate();
            let at = |(i, joint): (usize, &seeone_core::robot::Joint)| {
                let along = k as f64;
                let bent = (0.2 * along).sin() * bend[i];
                (start[i] * 0.8 + way[i] * along + bent).clamp(joint.lower(), joint.upper())
            };
            joints.map(at).collect()
        };
        (0..count).map(posture).collect()
    }

    #[test]
    fn twenty_thousand_trajectories_keep_every_limit_and_arrive() {
        let mut rng = generator(1, "trajectories");
        for round in 0..20 {
            let robot = ur5(&mut rng);
            let config = MotionConfig {
                speed: uniform(&mut rng, 0.2, 1.0),
                tool_acceleration_m_s2: uniform(&mut rng, 0.5, 20.0),
                ..MotionConfig::default()
            };
            let timing = Timing { robot: &robot, config: &config };
            for case in 0..1000 {
                let speed = uniform(&mut rng, 0.1, 2.0);
                let (trajectory, end) = if case % 4 == 0 {
                    let path = bent(&robot, &mut rng);
                    (timing.line(&[(&path, speed)]), path[path.len() - 1].clone())
                } else {
                    let path = vec![draw(&robot, &mut rng), draw(&robot, &mut rng)];
                    (timing.corners(&path, speed), path[1].clone())
                };
                let samples = &trajectory.positions;
                let last = &samples[samples.len() - 1];
                assert!(
                    last.iter().zip(&end).all(|(a, b)| (a - b).abs() <= 1e-8),
                    "{round} {case}"
                );
                for (i, joint) in robot.joints().iter().enumerate() {
                    let inside = |q: f64| q >= joint.lower() - 1e-9 && q <= joint.upper() + 1e-9;
                    assert!(samples.iter().all(|q| inside(q[i])), "{round} {case}");
                    for [first, second, third] in differences(samples, i, trajectory.period_s) {
                        assert!(first.abs() <= config.speed * joint.velocity() + 1e-9);
                        assert!(second.abs() <= robot.acceleration() + 1e-9);
                        assert!(third.abs() <= robot.jerk() + 1e-9, "{third}");
                    }
                }
            }
        }
    }

    /// The elbow comes to its limit, stays there and leaves it again.
    #[test]
    fn a_line_along_a_joints_limit_does_not_go_beyond_it() {
        let robot = ur5(&mut generator(3, "trajectories"));
        let config = MotionConfig::default();
        let timing = Timing { robot: &robot, config: &config };
        let limit = robot.joints()[2].upper();
        let elbow = |k: usize| limit - 0.02 * [4.0, 2.0, 0.0, 0.0, 0.0, 1.0, 4.0][k];
        let path: Vec<Vec<f64>> =
            (0..7).map(|k| vec![0.0, -1.5 + 0.01 * k as f64, elbow(k), 0.0, 0.0, 0.0]).collect();
        let beyond = Spline::through(&path);
        assert!((0..100).any(|k| beyond.at(f64::from(k) / 100.0)[2] > limit + 1e-4));
        let line = timing.line(&[(&path, 0.25)]);
        assert!(line.positions.iter().all(|q| robot.within_limits(q)));
        assert_eq!(line.positions.last(), path.last());
    }

    #[test]
    fn no_move_takes_longer_than_ruckigs_slowest_joint_and_a_period() {
        use rsruckig::prelude::{InputParameter, Ruckig, ThrowErrorHandler, Trajectory};
        let mut rng = generator(2, "trajectories");
        let robot = ur5(&mut rng);
        let config =
            MotionConfig { speed: 1.0, tool_acceleration_m_s2: 1e6, ..MotionConfig::default() };
        let timing = Timing { robot: &robot, config: &config };
        let mut ruckig = Ruckig::<6, ThrowErrorHandler>::new(None, config.period_s);
        for _ in 0..300 {
            let (a, b) = (draw(&robot, &mut rng), draw(&robot, &mut rng));
            let ours = timing.corners(&[a.clone(), b.clone()], 1e6).duration_s();
            let mut input = InputParameter::new(None);
            for (i, joint) in robot.joints().iter().enumerate() {
                (input.current_position[i], input.target_position[i]) = (a[i], b[i]);
                input.max_velocity[i] = joint.velocity();
                input.max_acceleration[i] = robot.acceleration();
                input.max_jerk[i] = robot.jerk();
            }
            let mut trajectory = Trajectory::new(None);
            ruckig.calculate(&input, &mut trajectory).unwrap();
            let theirs = trajectory.get_duration();
            assert!(
                ours >= theirs - 1e-9 && ours <= theirs + 2.0 * config.period_s,
                "{ours} {theirs}"
            );
        }
    }
}
