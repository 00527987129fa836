//! Start-goal pairs among a shelf and a post whose straight connection is blocked.

use nalgebra::Vector3;
use seeone_collision::{Checker, Margins};
use seeone_core::Pose;
use seeone_core::random::{Generator, generator, uniform};
use seeone_core::robot::{RobotModel, RobotOptions, Shape, Solid};
use seeone_plugin::Clearance;
use seeone_plugin::motion::Obstacle;
use std::f64::consts::{PI, TAU};
use std::path::Path;

/// How many pairs.
pub const PAIRS: usize = 200;
/// Distances kept from everything, metres.
pub const MARGINS: Margins = Margins { clearance_m: 0.005, carried_m: 0.03 };
/// The shipped arm.
pub fn ur5() -> RobotModel {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/ur5-ag95.urdf");
    RobotModel::from_urdf(&file, &RobotOptions::default()).expect("the shipped robot")
}

/// A table, a shelf of two boards on it, and a post.
pub fn cell() -> Vec<Obstacle> {
    let block = |name: &str, at: [f64; 3], half: [f64; 3]| {
        Obstacle::Solid(Solid {
            part: name.into(),
            shape: Shape::Box { half_m: Vector3::from(half) },
            pose: Pose::translation(at[0], at[1], at[2]),
        })
    };
    vec![
        Obstacle::Table { height_m: -0.02, soft_m: 0.0 },
        block("lower board", [0.55, 0.0, 0.30], [0.15, 0.35, 0.01]),
        block("upper board", [0.55, 0.0, 0.65], [0.15, 0.35, 0.01]),
        block("post", [-0.35, 0.35, 0.45], [0.04, 0.04, 0.45]),
    ]
}

/// A posture in which the arm touches nothing.
pub fn free_posture(checker: &Checker, rng: &mut Generator) -> Vec<f64> {
    loop {
        let q: Vec<f64> = (0..6).map(|_| uniform(rng, -PI, PI)).collect();
        if checker.contact(&q).is_none() {
            return q;
        }
    }
}

/// Free postures whose straight connection is blocked; the goal anywhere within half a turn from
/// zero, or at the whole turns nearest to the start, as kinematics give it.
pub fn blocked(robot: &RobotModel, checker: &Checker, nearest_turns: bool) -> Vec<[Vec<f64>; 2]> {
    let mut rng = generator(1, "pairs");
    let mut pairs = Vec::with_capacity(PAIRS);
    while pairs.len() < PAIRS {
        let (a, mut b) = (free_posture(checker, &mut rng), free_posture(checker, &mut rng));
        if nearest_turns {
            b = turned_towards(robot, &b, &a);
        }
        let on = |share: f64| a.iter().zip(&b).map(|(a, b)| a + share * (b - a)).collect();
        let mut on_the_way = (1..200).map(|k| -> Vec<f64> { on(f64::from(k) / 200.0) });
        if on_the_way.any(|q| checker.contact(&q).is_some()) {
            pairs.push([a, b]);
        }
    }
    pairs
}

/// The same posture with each joint at the allowed whole turn nearest to `near`.
fn turned_towards(robot: &RobotModel, q: &[f64], near: &[f64]) -> Vec<f64> {
    let joints = robot.joints().iter().zip(q.iter().zip(near));
    joints
        .map(|(joint, (q, near))| {
            let turned = q + TAU * ((near - q) / TAU).round();
            if joint.allows(turned) { turned } else { *q }
        })
        .collect()
}
