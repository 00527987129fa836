#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use nalgebra::{Translation3, Vector3};
use seeone_core::Pose;
use seeone_core::pose::difference;
use seeone_core::random::{generator, uniform};
use seeone_core::robot::{RobotModel, RobotOptions};
use seeone_plugin::{IkOutcome, IkQuery, IkStatus, Kinematics, PluginError};
use std::path::Path;

const HOME: [f64; 6] = [0.0, -1.5, 1.5, -1.5, -1.5, 0.0];

fn ur5() -> RobotModel {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/ur5-ag95.urdf");
    let base = Pose::new(Vector3::new(0.1, -0.2, 0.3), Vector3::new(0.3, 0.1, -0.4));
    RobotModel::from_urdf(&file, &RobotOptions { base, ..RobotOptions::default() }).unwrap()
}

fn draw(robot: &RobotModel, rng: &mut impl rand::Rng) -> Vec<f64> {
    robot.joints().iter().map(|j| uniform(rng, j.lower(), j.upper())).collect()
}

fn solve(solver: &dyn Kinematics, robot: &RobotModel, target: &Pose) -> IkOutcome {
    solver.solve(robot, &IkQuery::new(target, &HOME)).unwrap()
}

fn qp() -> QpIk {
    QpIk::new(IkConfig::default(), 1).unwrap()
}

/// Solves `count` reachable poses and gives the share of those it solved.
fn share(solver: &dyn Kinematics, count: usize) -> f64 {
    let robot = ur5();
    let mut rng = generator(7, "targets");
    let mut solved = 0;
    for _ in 0..count {
        let target = robot.tool_pose(&draw(&robot, &mut rng));
        let outcome = solve(solver, &robot, &target);
        if outcome.status != IkStatus::Solved {
            continue;
        }
        let (position, rotation) = difference(&robot.tool_pose(&outcome.joints), &target);
        assert!(position <= 1e-3 && rotation <= 1e-2 && robot.within_limits(&outcome.joints));
        solved += 1;
    }
    f64::from(solved) / count as f64
}

#[test]
fn every_reachable_pose_is_solved() {
    assert_eq!(share(&qp(), 1000), 1.0);
    assert_eq!(share(&DampedLeastSquares::new(IkConfig::default(), 1).unwrap(), 1000), 1.0);
}

#[test]
fn an_arm_without_a_closed_form_is_solved_from_seeded_starts() {
    let config = IkConfig { closed_form: false, ..IkConfig::default() };
    assert!(share(&QpIk::new(config.clone(), 1).unwrap(), 200) >= 0.99);
    assert!(share(&DampedLeastSquares::new(config, 1).unwrap(), 200) >= 0.99);
}

#[test]
fn the_closed_form_has_eight_exact_branches_the_original_among_them() {
    let robot = ur5();
    let geometry = ClosedForm::of(&robot).unwrap();
    let mut rng = generator(8, "branches");
    for _ in 0..300 {
        let q = draw(&robot, &mut rng);
        let target = robot.tool_pose(&q);
        let solutions = geometry.solve(&target, &q);
        assert!((2..=8).contains(&solutions.len()));
        for solution in &solutions {
            let (position, rotation) = difference(&robot.tool_pose(solution), &target);
            assert!(position < 1e-6 && rotation < 1e-6, "{position} {rotation}");
        }
        let same =
            |s: &&[f64; 6]| s.iter().zip(&q).all(|(a, b)| ((a - b) / 2.0).sin().abs() < 1e-4);
        assert!(solutions.iter().any(|s| same(&s)), "{q:?}");
    }
}

#[test]
fn an_unreachable_pose_says_by_how_much() {
    let robot = ur5();
    let far = Pose::from_parts(Translation3::new(2.0, 0.0, 0.5), robot.tool_pose(&HOME).rotation);
    let outcome = solve(&qp(), &robot, &far);
    assert_eq!(outcome.status, IkStatus::Infeasible);
    assert!(outcome.position_error_m > 0.5 && robot.within_limits(&outcome.joints));
    let told = outcome.reason.unwrap();
    assert!(told.contains(&format!("{:.1} mm", 1e3 * outcome.position_error_m)), "{told}");
}

#[test]
fn what_is_no_number_or_no_posture_is_refused() {
    let robot = ur5();
    let nan = Pose::from_parts(Translation3::new(f64::NAN, 0.0, 0.0), robot.tool().rotation);
    let ok = robot.tool_pose(&HOME);
    for (target, near) in [(&nan, &HOME[..]), (&ok, &HOME[..5]), (&ok, &[f64::NAN; 6])] {
        let told = qp().solve(&robot, &IkQuery::new(target, near));
        assert!(matches!(told, Err(PluginError::Input(_))));
    }
    let wrong = IkConfig { damping: f64::NAN, ..IkConfig::default() };
    assert!(QpIk::new(wrong, 0).is_err());
}

#[test]
fn a_line_is_followed_on_one_branch() {
    let robot = ur5();
    let start = robot.tool_pose(&HOME);
    let mut q = HOME.to_vec();
    for step in 1..=60 {
        let target = Translation3::new(0.0, -0.004 * f64::from(step), 0.0) * start;
        let query = IkQuery::continuous(&target, &q);
        let outcome = qp().solve(&robot, &query).unwrap();
        assert_eq!(outcome.status, IkStatus::Solved);
        assert!(outcome.position_error_m < 1e-4, "{}", outcome.position_error_m);
        let jump = outcome.joints.iter().zip(&q).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(jump < 0.05, "{jump} at {step}");
        q = outcome.joints;
    }
}

#[test]
fn the_same_question_has_the_same_answer() {
    let robot = ur5();
    let config = IkConfig { closed_form: false, ..IkConfig::default() };
    let target = robot.tool_pose(&draw(&robot, &mut generator(9, "again")));
    let solver = QpIk::new(config, 5).unwrap();
    assert_eq!(solve(&solver, &robot, &target), solve(&solver, &robot, &target));
}
