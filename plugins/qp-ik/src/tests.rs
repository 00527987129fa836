#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use nalgebra::{Translation3, Vector3};
use seeone_collision::{Checker, Margins};
use seeone_core::Pose;
use seeone_core::pose::difference;
use seeone_core::random::{generator, uniform};
use seeone_core::robot::{RobotModel, RobotOptions, Shape, Solid};
use seeone_plugin::motion::Obstacle;
use seeone_plugin::{Clearance, IkOutcome, IkQuery, IkStatus, Kinematics, PluginError};
use std::path::{Path, PathBuf};

const HOME: [f64; 6] = [0.0, -1.5, 1.5, -1.5, -1.5, 0.0];

fn shipped(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots").join(name)
}

fn robot(name: &str) -> RobotModel {
    RobotModel::from_urdf(&shipped(name), &RobotOptions::default()).unwrap()
}

fn ur5_at(base: Pose) -> RobotModel {
    let options = RobotOptions { base, ..RobotOptions::default() };
    RobotModel::from_urdf(&shipped("ur5-ag95.urdf"), &options).unwrap()
}

fn ur5() -> RobotModel {
    ur5_at(Pose::new(Vector3::new(0.1, -0.2, 0.3), Vector3::new(0.3, 0.1, -0.4)))
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
fn share(robot: &RobotModel, solver: &dyn Kinematics, count: usize) -> f64 {
    let mut rng = generator(7, "targets");
    let mut solved = 0;
    for _ in 0..count {
        let target = robot.tool_pose(&draw(robot, &mut rng));
        let query = IkQuery::new(&target, robot.home());
        let outcome = solver.solve(robot, &query).unwrap();
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
    assert_eq!(share(&ur5(), &qp(), 1000), 1.0);
    assert_eq!(share(&ur5(), &DampedLeastSquares::new(IkConfig::default(), 1).unwrap(), 1000), 1.0);
}

#[test]
fn without_its_closed_form_every_reachable_pose_is_solved_from_seeded_starts() {
    let config = IkConfig { closed_form: false, ..IkConfig::default() };
    assert_eq!(share(&ur5(), &QpIk::new(config.clone(), 1).unwrap(), 1000), 1.0);
    assert_eq!(share(&ur5(), &DampedLeastSquares::new(config, 1).unwrap(), 1000), 1.0);
}

/// A factory calibration moves every joint's origin by up to a millimetre and tilts it by up to
/// 3 mrad; older series of the arm differ by as much as that.
#[test]
fn a_calibrated_arm_reaches_every_reachable_pose() {
    let text = std::fs::read_to_string(shipped("ur5-ag95.urdf")).unwrap();
    let mut rng = generator(11, "calibration");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("calibrated.urdf");
    for _ in 0..5 {
        let mut off = || uniform(&mut rng, -1e-3, 1e-3);
        let calibrated = text
            .replace("0.089159", &format!("{}", 0.0892 + off()))
            .replace(
                "xyz=\"-0.425 0 0\"",
                &format!("xyz=\"{} {} {}\"", -0.425 + off(), off(), off()),
            )
            .replace(
                "xyz=\"-0.39225 0 0\"",
                &format!(
                    "xyz=\"{} 0 {}\" rpy=\"{} {} 0\"",
                    -0.39243 + off(),
                    off(),
                    3.0 * off(),
                    3.0 * off()
                ),
            )
            .replace("xyz=\"0 0 0.10915\"", &format!("xyz=\"{} 0 {}\"", off(), 0.110 + off()))
            .replace("xyz=\"0 0 0.09465\"", &format!("xyz=\"0 {} {}\"", off(), 0.09475 + off()));
        assert_ne!(calibrated, text);
        std::fs::write(&file, calibrated).unwrap();
        let robot = RobotModel::from_urdf(&file, &RobotOptions::default()).unwrap();
        assert!(ClosedForm::of(&robot).is_some(), "near enough to the structure");
        assert_eq!(share(&robot, &qp(), 1000), 1.0);
    }
}

#[test]
fn an_arm_of_seven_joints_reaches_every_reachable_pose() {
    let panda = robot("panda-ag95.urdf");
    assert!(ClosedForm::of(&panda).is_none());
    assert_eq!(share(&panda, &qp(), 1000), 1.0);
}

#[test]
fn a_limit_that_every_solution_breaks_is_named() {
    let text = std::fs::read_to_string(shipped("ur5-ag95.urdf")).unwrap();
    let narrow = "lower=\"-3.141592653589793\" upper=\"3.141592653589793\"";
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("narrow.urdf");
    std::fs::write(&file, text.replace(narrow, "lower=\"1.0\" upper=\"1.6\"")).unwrap();
    let robot = RobotModel::from_urdf(&file, &RobotOptions::default()).unwrap();
    let near = [0.0, -1.5, 1.5, -1.5, -1.5, 0.0];
    let target = ur5_at(Pose::identity()).tool_pose(&[0.3, -1.5, 2.2, -1.5, -1.5, 0.0]);
    let outcome = qp().solve(&robot, &IkQuery::new(&target, &near)).unwrap();
    assert_eq!(outcome.status, IkStatus::Infeasible);
    let reason = outcome.reason.unwrap();
    let named = reason.contains("elbow_joint would have to be at");
    assert!(named && reason.contains("not in 1.000..1.600 rad"), "{reason}");
}

#[test]
fn of_several_solutions_one_that_touches_nothing_is_taken() {
    let robot = ur5_at(Pose::identity());
    let checker = Checker::new(&robot, Margins::default(), &[], 0.095);
    let mut rng = generator(10, "touching");
    let (mut mended, mut none_free) = (0, 0);
    for _ in 0..300 {
        let target = robot.tool_pose(&draw(&robot, &mut rng));
        let blind = IkQuery::new(&target, &HOME);
        let seeing = IkQuery { clearance: Some(&checker), ..blind };
        let (blind, seeing) =
            (qp().solve(&robot, &blind).unwrap(), qp().solve(&robot, &seeing).unwrap());
        assert_eq!((blind.status, seeing.status), (IkStatus::Solved, IkStatus::Solved));
        assert_eq!(seeing.contact, checker.contact(&seeing.joints));
        assert_eq!(seeing.contact.is_some(), seeing.reason.is_some());
        none_free += usize::from(seeing.contact.is_some());
        mended += usize::from(seeing.contact.is_none() && checker.contact(&blind.joints).is_some());
    }
    assert!(mended > 10 && none_free > 3, "{mended} {none_free}");
}

/// Without a closed form the same is chosen by as with it: of what the starts lead to, the best goes
/// first by the criterion of `rank`, which the first solution met mostly does not.
#[test]
fn of_the_solutions_gathered_from_seeded_starts_the_best_is_taken() {
    let panda = robot("panda-ag95.urdf");
    let checker = Checker::new(&panda, Margins::default(), &[], 0.095);
    let gathering =
        |solutions| QpIk::new(IkConfig { solutions, ..IkConfig::default() }, 1).unwrap();
    let (first_come, several) = (gathering(1), gathering(IkConfig::default().solutions));
    let mut rng = generator(12, "gathered");
    let mut better = 0;
    for _ in 0..300 {
        let (target, near) = (panda.tool_pose(&draw(&panda, &mut rng)), draw(&panda, &mut rng));
        let query = IkQuery { clearance: Some(&checker), ..IkQuery::new(&target, &near) };
        let (first, best) =
            (first_come.solve(&panda, &query).unwrap(), several.solve(&panda, &query).unwrap());
        assert_eq!((first.status, best.status), (IkStatus::Solved, IkStatus::Solved));
        assert_eq!(first.contact.is_some(), best.contact.is_some());
        assert_eq!(several.solve(&panda, &query).unwrap(), best);
        if first.joints != best.joints && first.contact.is_none() {
            let ranked = rank::best_first(&panda, &near, vec![&first.joints, &best.joints]);
            assert_eq!(ranked[0], &best.joints);
            better += 1;
        }
    }
    assert!(better > 60, "{better} of 300");
}

/// The closed form has all of them, so what the seeded starts lead to can be held against it.
#[test]
fn the_numerical_route_mostly_takes_what_the_closed_form_takes() {
    let robot = ur5_at(Pose::identity());
    let numerical = |solutions| {
        let config = IkConfig { closed_form: false, solutions, ..IkConfig::default() };
        QpIk::new(config, 1).unwrap()
    };
    let taken = |solver: &QpIk| {
        let mut rng = generator(13, "both");
        let same = (0..300).filter(|_| {
            let (target, near) = (robot.tool_pose(&draw(&robot, &mut rng)), draw(&robot, &mut rng));
            let query = IkQuery::new(&target, &near);
            let chosen = solver.solve(&robot, &query).unwrap().joints;
            let best = qp().solve(&robot, &query).unwrap().joints;
            chosen.iter().zip(&best).all(|(a, b)| (a - b).abs() < 1e-3)
        });
        same.count()
    };
    let (first_come, several) = (taken(&numerical(1)), taken(&numerical(4)));
    assert!(first_come < 150 && several > 200, "{first_come} {several} of 300");
}

/// A tool that is sent through a post stops in front of it; unaware of it, it arrives.
#[test]
fn near_pairs_bound_the_steps() {
    let robot = ur5_at(Pose::identity());
    let there = robot.tool_pose(&HOME);
    let ahead = Pose::from_parts(
        Translation3::from(there.translation.vector + Vector3::new(0.1, 0.0, 0.0)),
        there.rotation,
    );
    let post = Obstacle::Solid(Solid {
        part: "post".into(),
        shape: Shape::Capsule { radius_m: 0.02, length_m: 1.2 },
        pose: Pose::from(ahead.translation),
    });
    let checker = Checker::new(&robot, Margins::default(), &[post], 0.05);
    let query = IkQuery::continuous(&ahead, &HOME);
    assert_eq!(qp().solve(&robot, &query).unwrap().status, IkStatus::Solved);
    assert!(checker.contact(&qp().solve(&robot, &query).unwrap().joints).is_some());
    let mut workspace =
        descent::Workspace::<quadratic::Quadratic>::new(&IkConfig::default(), 6, true);
    let query = IkQuery { clearance: Some(&checker), ..query };
    let config = IkConfig { step_rad: 0.02, ..IkConfig::default() };
    let (miss, _) = workspace.descend(&robot, &query, &HOME, true, &config);
    let contact = checker.contact(&workspace.best);
    assert!(contact.as_ref().is_none_or(|c| c.distance_m > -1e-3), "{contact:?}");
    assert!((0.01..0.099).contains(&miss.position_m), "{miss:?}");
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
fn a_pose_in_the_arms_own_foot_says_what_is_in_the_way() {
    let robot = ur5_at(Pose::identity());
    let checker = Checker::new(&robot, Margins::default(), &[], 0.095);
    let down = robot.tool_pose(&HOME).rotation;
    let foot = Pose::from_parts(Translation3::new(0.02, 0.02, 0.15), down);
    let numerical = IkConfig { closed_form: false, ..IkConfig::default() };
    let axis = "mm nearer to the axis of shoulder_pan_joint than the arm can fold";
    let links = "off, where no joint is at its limit and nothing touches";
    for (solver, told) in [(qp(), axis), (QpIk::new(numerical, 1).unwrap(), links)] {
        let query = IkQuery { clearance: Some(&checker), ..IkQuery::new(&foot, &HOME) };
        let outcome = solver.solve(&robot, &query).unwrap();
        assert_eq!(outcome.status, IkStatus::Infeasible);
        assert_eq!(outcome.contact, checker.contact(&outcome.joints));
        let reason = outcome.reason.unwrap();
        assert!(reason.contains(told), "{reason}");
    }
    // What a closed hand meets there, when the foot is thicker, is told as well.
    let post = Obstacle::Solid(Solid {
        part: "post".into(),
        shape: Shape::Capsule { radius_m: 0.1, length_m: 0.3 },
        pose: Pose::from(foot.translation),
    });
    let checker = Checker::new(&robot, Margins::default(), &[post], 0.05);
    let query = IkQuery { clearance: Some(&checker), ..IkQuery::new(&foot, &HOME) };
    let outcome = qp().solve(&robot, &query).unwrap();
    let reason = outcome.reason.unwrap();
    assert!(reason.contains("in that posture") && reason.contains("post"), "{reason}");
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
    assert!(told.contains("beyond the arm's reach"), "{told}");
}

#[test]
fn what_is_no_number_or_no_posture_is_refused() {
    let robot = ur5();
    let nan = Pose::from_parts(Translation3::new(f64::NAN, 0.0, 0.0), robot.tool().rotation);
    let ok = robot.tool_pose(&HOME);
    for (target, near) in
        [(&nan, &HOME[..]), (&ok, &HOME[..5]), (&ok, &[f64::NAN; 6]), (&ok, &[7.0; 6])]
    {
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
