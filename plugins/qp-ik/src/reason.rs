//! Why a query has no answer, or none that touches nothing.

use crate::descent::Miss;
use crate::seeds::{Bar, Excess};
use seeone_core::robot::RobotModel;
use seeone_plugin::{Contact, IkQuery};

/// A joint this near to where it may not go is held up by it, radians.
const STUCK_RAD: f64 = 1e-3;

/// Why `query` is not solved: how far off `best`, the nearest posture found, is, what keeps every
/// exact solution away, what holds the arm up there, and what it touches.
pub(crate) fn unsolved(
    robot: &RobotModel,
    query: &IkQuery,
    best: &[f64],
    miss: Miss,
    bar: Option<Bar>,
    contact: Option<&Contact>,
) -> String {
    let (millimetres, degrees) = (1e3 * miss.position_m, miss.rotation_rad.to_degrees());
    let branch = if query.continuous { " on this branch" } else { "" };
    let mut told = format!(
        "the nearest posture found{branch} is {millimetres:.1} mm and {degrees:.1} degrees off"
    );
    let beyond = beyond_reach(robot, query);
    if beyond > 0.0 {
        told += &format!("; the target is {:.1} mm at least beyond the arm's reach", 1e3 * beyond);
        return told;
    }
    match bar {
        Some(Bar::Limit(Excess { joint, position, .. })) => {
            let joint = &robot.joints()[joint];
            let (name, low, high) = (joint.name(), joint.lower(), joint.upper());
            told += &format!(
                "; {name} would have to be at {position:.3}, not in {low:.3}..{high:.3} rad"
            );
        }
        Some(Bar::Axis(inside)) => {
            let (name, millimetres) = (robot.joints()[0].name(), 1e3 * inside);
            told += &format!(
                "; the wrist would be {millimetres:.1} mm nearer to the axis of {name} than the arm can fold"
            );
        }
        Some(Bar::Links) => told += "; no angles of the joints bring the arm there",
        None => {
            let held = held_up(robot, query, best);
            if held.is_empty() && contact.is_none() {
                let asked = query.clearance.is_some();
                let nothing = if asked { " and nothing touches" } else { "" };
                told += &format!(", where no joint is at its limit{nothing}");
            }
            told += &held;
        }
    }
    if let Some(contact) = contact {
        told += &format!("; in that posture {contact}");
    }
    told
}

/// Which joints of `best` can go no further.
fn held_up(robot: &RobotModel, query: &IkQuery, best: &[f64]) -> String {
    let mut told = String::new();
    let joints = || robot.joints().iter().zip(best.iter().zip(query.near));
    let at_limit: Vec<&str> = joints()
        .filter(|(joint, (q, _))| (*q - joint.lower()).min(joint.upper() - *q) < STUCK_RAD)
        .map(|(joint, _)| joint.name())
        .collect();
    if !at_limit.is_empty() {
        told += &format!(", with {} at the limit", at_limit.join(", "));
    }
    let Some(period) = query.period_s else { return told };
    let hurried: Vec<&str> = joints()
        .filter(|(joint, (q, near))| {
            (*q - *near).abs() > joint.velocity() * period * (1.0 - STUCK_RAD)
        })
        .map(|(joint, _)| joint.name())
        .collect();
    if !hurried.is_empty() {
        told += &format!(", with {} at the largest speed", hurried.join(", "));
    }
    told
}

/// How far the target is beyond what the arm reaches when every link points at it, metres;
/// negative within.
fn beyond_reach(robot: &RobotModel, query: &IkQuery) -> f64 {
    let joints = robot.joints();
    let first = robot.base() * joints[0].origin();
    let links = joints[1..].iter().map(|joint| joint.origin().translation.vector.norm());
    let reach = links.sum::<f64>() + robot.tool().translation.vector.norm();
    query.target.translation.vector.metric_distance(&first.translation.vector) - reach
}

/// That every one of `solutions` touches something, `contact` the best of them.
pub(crate) fn touching(contact: &Contact, solutions: usize) -> String {
    match solutions {
        1 => contact.to_string(),
        more => format!("{contact} in the best of {more} solutions, and none is free"),
    }
}
