//! Where descents start.

use crate::ClosedForm;
use nalgebra::Matrix6xX;
use seeone_core::Pose;
use seeone_core::random::{generator, uniform};
use seeone_core::robot::RobotModel;
use std::f64::consts::TAU;

/// What coming within a radian of a joint limit costs, in square radians of joint travel.
const LIMIT_COST: f64 = 0.2;
/// What being singular costs beside the least singular of all solutions, in the same.
const SINGULAR_COST: f64 = 0.2;

/// The closed form's solutions for one target.
pub(crate) struct Known {
    /// Those within the limits, each joint at the whole turn nearest to the start, the best
    /// first.
    pub(crate) seeds: Vec<Vec<f64>>,
    /// Of those that break a limit, the one that does by least.
    pub(crate) excess: Option<Excess>,
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

/// The closed form's solutions for `target`, ranked by the way from `near`, limits and
/// singularities.
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
            Ok(q) => seeds.push((cost(robot, &q, near), manipulability(robot, &q), q)),
            Err(found) if excess.is_none_or(|least| found.beyond < least.beyond) => {
                excess = Some(found);
            }
            Err(_) => {}
        }
    }
    let most = seeds.iter().map(|seed| seed.1).fold(f64::MIN_POSITIVE, f64::max);
    let rank = |seed: &(f64, f64, Vec<f64>)| seed.0 + SINGULAR_COST * (1.0 - seed.1 / most);
    seeds.sort_by(|a, b| rank(a).total_cmp(&rank(b)));
    Known { seeds: seeds.into_iter().map(|(_, _, q)| q).collect(), excess }
}

/// Seeded draws within the limits, the same for every target.
pub(crate) fn random(
    robot: &RobotModel,
    seed: u64,
    count: usize,
) -> impl Iterator<Item = Vec<f64>> {
    let mut rng = generator(seed, "kinematics");
    (0..count).map(move |_| {
        robot.joints().iter().map(|j| uniform(&mut rng, j.lower(), j.upper())).collect()
    })
}

/// Joint travel from `near`, squared, and closeness to limits.
fn cost(robot: &RobotModel, q: &[f64], near: &[f64]) -> f64 {
    let joints = robot.joints().iter().zip(q.iter().zip(near));
    joints
        .map(|(joint, (q, near))| {
            let margin = (q - joint.lower()).min(joint.upper() - q);
            (q - near).powi(2) + LIMIT_COST * (1.0 - margin).max(0.0).powi(2)
        })
        .sum()
}

/// How far an arm of six joints is from being singular, `|det J|` (Yoshikawa 1985).
fn manipulability(robot: &RobotModel, q: &[f64]) -> f64 {
    let jacobian: Matrix6xX<f64> = robot.jacobian(q);
    jacobian.fixed_columns::<6>(0).determinant().abs()
}

/// `q` with each joint turned by whole turns to where it is allowed and nearest to `near`.
///
/// # Errors
/// The joint that has no such position and misses one by most.
fn within_turns(robot: &RobotModel, q: &[f64], near: &[f64]) -> Result<Vec<f64>, Excess> {
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

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use seeone_core::robot::RobotOptions;
    use std::path::Path;

    /// Joint travel from `near`, least margin from a limit, and manipulability.
    fn measured(robot: &RobotModel, q: &[f64], near: &[f64]) -> (f64, f64, f64) {
        let travel = q.iter().zip(near).map(|(q, near)| (q - near).powi(2)).sum::<f64>();
        let margins = robot.joints().iter().zip(q);
        let margin = margins.map(|(joint, q)| (q - joint.lower()).min(joint.upper() - q));
        (travel, margin.fold(f64::INFINITY, f64::min), manipulability(robot, q))
    }

    #[test]
    fn the_nearest_solution_goes_first_unless_one_is_clearer_of_limits_or_singularities() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/ur5-ag95.urdf");
        let robot = RobotModel::from_urdf(&file, &RobotOptions::default()).unwrap();
        let geometry = ClosedForm::of(&robot).unwrap();
        let mut rng = generator(3, "ranked");
        let mut draw = || -> Vec<f64> {
            robot.joints().iter().map(|j| uniform(&mut rng, j.lower(), j.upper())).collect()
        };
        let (mut nearest_first, mut for_limits, mut for_singularities) = (0, 0, 0);
        for _ in 0..20_000 {
            let (target, near) = (robot.tool_pose(&draw()), draw());
            let seeds = closed_form(&geometry, &robot, &target, &near).seeds;
            let of = |q: &Vec<f64>| measured(&robot, q, &near);
            let (travel, margin, clear) = of(&seeds[0]);
            let nearest = seeds.iter().map(of).min_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
            if nearest.0 >= travel - 1e-9 {
                nearest_first += 1;
                continue;
            }
            // The way is longer by no more than what both costs together can weigh.
            assert!(travel - nearest.0 < 6.0 * LIMIT_COST + SINGULAR_COST, "{travel} {nearest:?}");
            assert!(margin > nearest.1 || clear > nearest.2, "{margin} {clear} {nearest:?}");
            for_limits += usize::from(margin > nearest.1 && clear <= nearest.2);
            for_singularities += usize::from(clear > nearest.2 && margin <= nearest.1);
        }
        assert!(nearest_first > 19_000, "{nearest_first}");
        assert!(for_limits > 5 && for_singularities > 5, "{for_limits} {for_singularities}");
    }
}
