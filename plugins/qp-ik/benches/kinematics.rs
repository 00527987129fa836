//! Times of inverse kinematics: whole answers from home, the numerical route, an arm without a
//! closed form, one quadratic program, and straight lines at 125 Hz.
//!
//! `cargo bench -p seeone-qp-ik` prints criterion's figures, and for whole answers a table of
//! how they are spread: of each target the best of several runs, which is what the machine
//! does when nothing else disturbs it.

#![allow(clippy::print_stdout, reason = "a table is what it is for")]

use criterion::{BatchSize, Criterion};
use nalgebra::DVector;
use seeone_collision::{Checker, Margins};
use seeone_core::Pose;
use seeone_core::random::{direction, generator, uniform};
use seeone_core::robot::{RobotModel, RobotOptions};
use seeone_plugin::{Clearance, IkQuery, IkStatus, Kinematics};
use seeone_qp_ik::{DampedLeastSquares, IkConfig, QpIk, QuadraticProgram};
use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

#[path = "../tests/support/active_set.rs"]
mod active_set;
#[path = "../tests/support/problems.rs"]
mod problems;

const TARGETS: usize = 1000;
const RUNS: usize = 5;
/// The homes of the shipped robot files, degrees.
const UR5_HOME: [f64; 6] = [0.0, -110.0, 80.0, -60.0, -90.0, 0.0];
const PANDA_HOME: [f64; 7] = [0.0, -45.0, 0.0, -135.0, 0.0, 90.0, 45.0];

fn robot(name: &str) -> RobotModel {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots").join(name);
    let options = RobotOptions { tool_link: "tool0".into(), ..RobotOptions::default() };
    RobotModel::from_urdf(&file, &options).expect("a shipped robot")
}

/// Reachable flange poses, uniform in joint space.
fn targets(robot: &RobotModel) -> Vec<Pose> {
    let mut rng = generator(1, "targets");
    let mut draw = || -> Vec<f64> {
        robot.joints().iter().map(|j| uniform(&mut rng, j.lower(), j.upper())).collect()
    };
    (0..TARGETS).map(|_| robot.tool_pose(&draw())).collect()
}

/// One route to an answer.
struct Route<'a> {
    name: &'static str,
    robot: &'a RobotModel,
    home: &'a [f64],
    solver: Box<dyn Kinematics>,
    clearance: Option<&'a dyn Clearance>,
}

impl Route<'_> {
    fn solve(&self, target: &Pose) -> bool {
        let query = IkQuery { clearance: self.clearance, ..IkQuery::new(target, self.home) };
        let outcome = self.solver.solve(self.robot, &query).expect("a sound question");
        outcome.status == IkStatus::Solved
    }

    /// A line of the table.
    fn table(&self, targets: &[Pose]) {
        let mut solved = 0;
        let time = |target: &Pose| {
            let clock = Instant::now();
            black_box(self.solve(black_box(target)));
            1e6 * clock.elapsed().as_secs_f64()
        };
        let best = |target| (0..RUNS).map(|_| time(target)).fold(f64::INFINITY, f64::min);
        let mut times = Vec::with_capacity(targets.len());
        for target in targets {
            solved += usize::from(self.solve(target));
            times.push(best(target));
        }
        times.sort_by(f64::total_cmp);
        let (median, p95) = (times[TARGETS / 2], times[TARGETS * 95 / 100]);
        let worst = times[TARGETS - 1];
        println!("| {:<44} | {solved:>4} | {median:>7.1} | {p95:>7.1} | {worst:>8.1} |", self.name);
    }
}

fn answers(criterion: &mut Criterion) {
    let (ur5, panda) = (robot("ur5-ag95.urdf"), robot("panda-ag95.urdf"));
    let (ur5_targets, panda_targets) = (targets(&ur5), targets(&panda));
    let (ur5_home, panda_home) = (UR5_HOME.map(f64::to_radians), PANDA_HOME.map(f64::to_radians));
    let itself = Checker::new(&ur5, Margins::default(), &[], 0.095);
    let numerical = IkConfig { closed_form: false, ..IkConfig::default() };
    let qp = |config: &IkConfig| Box::new(QpIk::new(config.clone(), 1).expect("options"));
    let damped = DampedLeastSquares::new(IkConfig::default(), 1).expect("options");
    let shipped = IkConfig::default();
    let on_ur5 = |name, solver: Box<dyn Kinematics>| Route {
        name,
        robot: &ur5,
        home: &ur5_home,
        solver,
        clearance: None,
    };
    let routes = [
        (on_ur5("UR5", qp(&shipped)), &ur5_targets),
        (
            Route { clearance: Some(&itself), ..on_ur5("UR5, clear of itself", qp(&shipped)) },
            &ur5_targets,
        ),
        (on_ur5("UR5, damped least squares", Box::new(damped)), &ur5_targets),
        (on_ur5("UR5, numerical route", qp(&numerical)), &ur5_targets),
        (
            Route { robot: &panda, home: &panda_home, ..on_ur5("Panda (7 joints)", qp(&shipped)) },
            &panda_targets,
        ),
    ];
    println!("| {:<44} | of {TARGETS} solved | median us | 95 % us | worst us |", "route");
    println!("|---|---|---|---|---|");
    for (route, targets) in &routes {
        route.table(targets);
    }
    for (route, targets) in &routes {
        let mut next = targets.iter().cycle();
        criterion.bench_function(route.name, |bencher| {
            bencher.iter_batched(
                || next.next().expect("a cycle"),
                |target| route.solve(target),
                BatchSize::SmallInput,
            );
        });
    }
}

fn one_program(criterion: &mut Criterion) {
    let robot = problems::ur5();
    let mut rng = generator(1, "near-singular");
    let owned: Vec<_> = (0..300).map(|_| problems::near_singular(&robot, &mut rng)).collect();
    let mut program = QuadraticProgram::new(6, 12);
    let mut x = DVector::zeros(6);
    let mut worst: f64 = 0.0;
    let mut times: Vec<f64> = Vec::with_capacity(owned.len());
    for problem in owned.iter().map(problems::Owned::problem) {
        let mut time = || {
            let clock = Instant::now();
            assert!(program.solve(black_box(&problem), &mut x));
            1e6 * clock.elapsed().as_secs_f64()
        };
        times.push((0..RUNS).map(|_| time()).fold(f64::INFINITY, f64::min));
        worst = worst.max((&x - active_set::minimum(&problem)).amax());
    }
    times.sort_by(f64::total_cmp);
    let (median, p95) = (times[times.len() / 2], times[times.len() * 95 / 100]);
    println!("one program of 6 unknowns and 24 rows: median {median:.1}, 95 % {p95:.1} us");
    println!("its worst error beside an active-set method: {worst:.1e} rad of 300");
    let mut next = owned.iter().cycle();
    criterion.bench_function("one program, memory used again", |bencher| {
        bencher.iter(|| program.solve(&next.next().expect("a cycle").problem(), &mut x));
    });
    criterion.bench_function("one program, solver made anew", |bencher| {
        bencher.iter(|| {
            QuadraticProgram::new(6, 12).solve(&next.next().expect("a cycle").problem(), &mut x)
        });
    });
}

/// A line of 0.15 m at 0.19 m/s with a little turn, 125 poses a second.
fn line(robot: &RobotModel, start: &[f64], rng: &mut impl rand::Rng) -> Vec<Pose> {
    let first = robot.tool_pose(start);
    let (along, turn) = (direction(rng) * 0.15, direction(rng) * 0.1);
    (1..=100)
        .map(|k| f64::from(k) / 100.0)
        .map(|share| {
            let turned = first.rotation * nalgebra::UnitQuaternion::new(turn * share);
            Pose::from_parts((first.translation.vector + along * share).into(), turned)
        })
        .collect()
}

fn lines(criterion: &mut Criterion) {
    let robot = robot("ur5-ag95.urdf");
    let solver = QpIk::new(IkConfig::default(), 1).expect("options");
    let mut rng = generator(1, "lines");
    let around = [0.0, -1.6, 1.5, -1.2, -1.5, 0.0];
    let lines: Vec<(Vec<f64>, Vec<Pose>)> = (0..50)
        .map(|_| {
            let start: Vec<f64> = around.iter().map(|q| q + uniform(&mut rng, -0.2, 0.2)).collect();
            let poses = line(&robot, &start, &mut rng);
            (start, poses)
        })
        .collect();
    let follow = |(start, poses): &(Vec<f64>, Vec<Pose>)| {
        let mut at = start.clone();
        let mut worst = (0.0f64, 0.0f64);
        for pose in poses {
            let query = IkQuery { period_s: Some(0.008), ..IkQuery::continuous(pose, &at) };
            let found = solver.solve(&robot, &query).expect("a sound question");
            worst.0 = worst.0.max(found.position_error_m);
            worst.1 = worst.1.max(found.rotation_error_rad);
            at = found.joints;
        }
        worst
    };
    let worst =
        lines.iter().map(follow).fold((0.0f64, 0.0f64), |a, b| (a.0.max(b.0), a.1.max(b.1)));
    println!("50 lines at 125 Hz: worst {:.4} mm, {:.4} mrad", 1e3 * worst.0, 1e3 * worst.1);
    let mut next = lines.iter().cycle();
    criterion.bench_function("a line of 100 poses at 125 Hz", |bencher| {
        bencher.iter(|| follow(next.next().expect("a cycle")));
    });
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    answers(&mut criterion);
    one_program(&mut criterion);
    lines(&mut criterion);
    criterion.final_summary();
}
