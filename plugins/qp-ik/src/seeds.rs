//! Where descents start.

use crate::ClosedForm;
use crate::rank::best_first;
use seeone_core::Pose;
use seeone_core::random::{generator, uniform};
use seeone_core::robot::{Joint, RobotModel};
use std::f64::consts::TAU;

/// What the closed form knows of one target.
#[derive(Debug)]
pub(crate) enum Known {
    /// Its solutions within the limits, at least one, each joint at the whole turn nearest to
    /// the start, the best first.
    Solutions(Vec<Vec<f64>>),
    /// It has none, and why.
    Barred(Bar),
}

/// What keeps every exact solution away.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Bar {
    /// Each breaks a limit; the one that does by least.
    Limit(Excess),
    /// The wrist would be nearer to the first joint's axis than the arm can fold, by so many
    /// metres.
    Axis(f64),
    /// No angles of the joints bring the tool there.
    Links,
}

/// A joint beyond its limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Excess {
    /// Its index.
    pub(crate) joint: usize,
    /// Where it would have to be, radians.
    pub(crate) position: f64,
    /// How far that is beyond, radians.
    pub(crate) beyond: f64,
}

/// The closed form's solutions for `target`, ranked as seen from `near`.
pub(crate) fn closed_form(
    geometry: &ClosedForm,
    robot: &RobotModel,
    target: &Pose,
    near: &[f64],
) -> Known {
    let mut seeds = Vec::new();
    let mut excess: Option<Excess> = None;
    for solution in geometry.solve(target, near) {
        match within_turns(robot, &solution, near) {
            Ok(q) => seeds.push(q),
            Err(found) if excess.is_none_or(|least| found.beyond < least.beyond) => {
                excess = Some(found);
            }
            Err(_) => {}
        }
    }
    if !seeds.is_empty() {
        return Known::Solutions(best_first(robot, near, seeds));
    }
    let inside = geometry.inside(target);
    let links = || if inside > 0.0 { Bar::Axis(inside) } else { Bar::Links };
    Known::Barred(excess.map_or_else(links, Bar::Limit))
}

/// Seeded draws within the limits, the same for every target, and every other one of them moved half
/// the way to `near`, where the better solutions are.
pub(crate) fn random(
    robot: &RobotModel,
    near: &[f64],
    seed: u64,
    count: usize,
) -> impl Iterator<Item = Vec<f64>> {
    let mut rng = generator(seed, "kinematics");
    (0..count).map(move |index| {
        let share = if index % 2 == 0 { 0.5 } else { 1.0 };
        let joints = robot.joints().iter().zip(near);
        let mut draw = |joint: &Joint| uniform(&mut rng, joint.lower(), joint.upper());
        joints.map(|(joint, near)| share * draw(joint) + (1.0 - share) * near).collect()
    })
}

/// `q` with each joint turned by whole turns to where it is allowed and nearest to `near`.
///
/// # Errors
/// The joint that has no such position and misses one by most.
pub(crate) fn within_turns(
    robot: &RobotModel,
    q: &[f64],
    near: &[f64],
) -> Result<Vec<f64>, Excess> {
    let mut turned = Vec::with_capacity(q.len());
    let mut worst: Option<Excess> = None;
    for (index, (joint, (q, near))) in robot.joints().iter().zip(q.iter().zip(near)).enumerate() {
        let nearest = q + TAU * ((near - q) / TAU).round();
        let turns = [nearest, nearest - TAU, nearest + TAU];
        let allowed = turns.into_iter().filter(|position| joint.allows(*position));
        match allowed.min_by(|a, b| (a - near).abs().total_cmp(&(b - near).abs())) {
            Some(position) => turned.push(position),
            None => {
                let beyond = |p: f64| (joint.lower() - p).max(p - joint.upper());
                let misses = turns.map(|position| Excess {
                    joint: index,
                    position,
                    beyond: beyond(position),
                });
                let least = misses.into_iter().min_by(|a, b| a.beyond.total_cmp(&b.beyond));
                worst = worst.into_iter().chain(least).max_by(|a, b| a.beyond.total_cmp(&b.beyond));
            }
        }
    }
    worst.map_or(Ok(turned), Err)
}
