//! Which of several solutions is taken: the one criterion of every route to them.

use nalgebra::Matrix6xX;
use seeone_core::robot::RobotModel;

/// What coming within a radian of a joint limit costs, in square radians of joint travel.
const LIMIT_COST: f64 = 0.2;
/// What being singular costs beside the least singular of all solutions, in the same.
const SINGULAR_COST: f64 = 0.2;

/// `solutions` of one target, the best first: by the squared way from `near` in radians, closeness to limits,
/// and manipulability beside the best of them. Equals keep their order.
pub(crate) fn best_first<Q: AsRef<[f64]>>(
    robot: &RobotModel,
    near: &[f64],
    solutions: Vec<Q>,
) -> Vec<Q> {
    let weigh = |q: Q| (cost(robot, q.as_ref(), near), manipulability(robot, q.as_ref()), q);
    let mut weighed: Vec<(f64, f64, Q)> = solutions.into_iter().map(weigh).collect();
    let most = weighed.iter().map(|(_, clear, _)| *clear).fold(f64::MIN_POSITIVE, f64::max);
    let rank = |(cost, clear, _): &(f64, f64, Q)| cost + SINGULAR_COST * (1.0 - clear / most);
    weighed.sort_by(|a, b| rank(a).total_cmp(&rank(b)));
    weighed.into_iter().map(|(_, _, q)| q).collect()
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

/// How far an arm is from being singular, `sqrt(det(J J^T))` (Yoshikawa 1985).
fn manipulability(robot: &RobotModel, q: &[f64]) -> f64 {
    let jacobian: Matrix6xX<f64> = robot.jacobian(q);
    if jacobian.ncols() == 6 {
        // The same number, in half the time.
        return jacobian.fixed_columns::<6>(0).determinant().abs();
    }
    // Rounding leaves a little below zero where it is singular.
    (&jacobian * jacobian.transpose()).determinant().max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use crate::{
        ClosedForm,
        seeds::{self, Known},
    };
    use seeone_core::random::{generator, uniform};
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
            let Known::Solutions(seeds) = seeds::closed_form(&geometry, &robot, &target, &near)
            else {
                panic!()
            };
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
