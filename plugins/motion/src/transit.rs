//! Free-space moves between two postures.

use crate::MotionConfig;
use crate::failure::Failure;
use crate::rrt::{Search, distance};
use rand::RngExt;
use seeone_collision::{Checker, Rules};
use seeone_core::random::Generator;
use seeone_core::robot::RobotModel;
use seeone_plugin::Contact;

/// How far beyond its two ends a planned transit may move a joint, radians.
const DETOUR_RAD: f64 = 1.6;

/// How to move from one posture to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Style {
    /// Straight in joint space or not at all.
    Straight,
    /// Straight where that is free, otherwise planned.
    Planned,
}

/// A free path of straight lines in joint space from `start` to `goal`. What
/// is carried stays as far from obstacles as the two ends allow.
///
/// # Errors
/// What is in the way.
pub(crate) fn transit(
    robot: &RobotModel,
    config: &MotionConfig,
    checker: &Checker,
    style: Style,
    (start, goal): (&[f64], &[f64]),
    rng: &mut Generator,
) -> Result<Vec<Vec<f64>>, Failure> {
    let room = checker.room([&robot.tool_pose(start), &robot.tool_pose(goal)]);
    let rules = Rules { fingers_may_touch: false, room: Some(&room) };
    let blocked = |a: &[f64], b: &[f64]| first_contact(config, checker, &rules, a, b);
    for (end, name) in [(start, "start"), (goal, "end")] {
        if let Some(contact) = checker.contact_under(end, &rules) {
            return Err(Failure::Infeasible(format!("at its {name} {contact}")));
        }
    }
    let Some(contact) = blocked(start, goal) else {
        return Ok(vec![start.to_vec(), goal.to_vec()]);
    };
    if style == Style::Straight {
        let reason = format!("the straight joint move is blocked: {contact}");
        return Err(Failure::Infeasible(reason));
    }
    let joints = robot.joints().iter().zip(start.iter().zip(goal));
    let bounds: Vec<(f64, f64)> = joints
        .map(|(joint, (a, b))| {
            let (low, high) = (a.min(*b) - DETOUR_RAD, a.max(*b) + DETOUR_RAD);
            (low.max(joint.lower()), high.min(joint.upper()))
        })
        .collect();
    let free = |a: &[f64], b: &[f64]| is_free(config, checker, &rules, a, b);
    let search = Search { bounds: &bounds, free: &free, extensions: config.extensions };
    match search.connect(start, goal, rng) {
        Some(path) => Ok(shortened(path, config.shortcuts, &free, rng)),
        None => Err(Failure::Infeasible(format!(
            "no free path after {} extensions; the straight one is blocked: {contact}",
            config.extensions
        ))),
    }
}

/// Whether the straight line from `a` to `b` is free, `a` itself left out. The middle is looked at
/// first, then the middles of what is left: that is where contact is found soonest.
fn is_free(config: &MotionConfig, checker: &Checker, rules: &Rules, a: &[f64], b: &[f64]) -> bool {
    let steps = steps(config, a, b);
    let strides = std::iter::successors(Some(steps.next_power_of_two()), |stride| {
        (*stride > 1).then_some(stride / 2)
    });
    // Odd multiples of each stride: every step once.
    let mut order = strides.flat_map(|stride| (stride..=steps).step_by(2 * stride));
    order.all(|k| checker.contact_under(&on(a, b, k as f64 / steps as f64), rules).is_none())
}

/// Steps between which nothing is looked at.
fn steps(config: &MotionConfig, a: &[f64], b: &[f64]) -> usize {
    let furthest = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    (furthest / config.joint_step_rad).ceil().max(1.0) as usize
}

/// The posture `share` of the way from `a` to `b`.
fn on(a: &[f64], b: &[f64], share: f64) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a + share * (b - a)).collect()
}

/// The first contact on the straight line from `a` to `b`, `a` itself left out.
fn first_contact(
    config: &MotionConfig,
    checker: &Checker,
    rules: &Rules,
    a: &[f64],
    b: &[f64],
) -> Option<Contact> {
    let steps = steps(config, a, b);
    (1..=steps).find_map(|k| checker.contact_under(&on(a, b, k as f64 / steps as f64), rules))
}

/// The path with corners cut where the straight line is free.
fn shortened(
    mut path: Vec<Vec<f64>>,
    attempts: usize,
    free: &dyn Fn(&[f64], &[f64]) -> bool,
    rng: &mut Generator,
) -> Vec<Vec<f64>> {
    for _ in 0..attempts {
        if path.len() < 3 {
            break;
        }
        let pieces = path.len() - 1;
        let (mut i, mut j) = (rng.random_range(0..pieces), rng.random_range(0..pieces));
        if i > j {
            std::mem::swap(&mut i, &mut j);
        }
        let mut drawn = |piece: usize| on(&path[piece], &path[piece + 1], rng.random::<f64>());
        let (a, b) = (drawn(i), drawn(j));
        if i == j {
            continue;
        }
        let around: f64 = distance(&a, &path[i + 1])
            + path[i + 1..=j].windows(2).map(|pair| distance(&pair[0], &pair[1])).sum::<f64>()
            + distance(&path[j], &b);
        if distance(&a, &b) < 0.99 * around && free(&a, &b) {
            path.splice(i + 1..=j, [a, b]);
        }
    }
    path
}
