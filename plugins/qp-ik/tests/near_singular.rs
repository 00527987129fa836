//! The quadratic programs near singularities against an active-set method.

#[path = "support/active_set.rs"]
mod active_set;
#[path = "support/problems.rs"]
mod problems;

use nalgebra::{DMatrix, DVector};
use problems::{near_singular, ur5};
use seeone_core::random::generator;
use seeone_plugin::{IkQuery, IkStatus, Kinematics};
use seeone_qp_ik::{IkConfig, Problem, QpIk, QuadraticProgram};

#[test]
fn near_singularities_every_step_is_the_exact_one() {
    let robot = ur5();
    let mut rng = generator(1, "near-singular");
    let mut program = QuadraticProgram::new(6, 12);
    let (mut x, mut worst, mut limited) = (DVector::zeros(6), 0.0f64, 0);
    for case in 0..3000 {
        let owned = near_singular(&robot, &mut rng);
        let problem = owned.problem();
        assert!(program.solve(&problem, &mut x), "case {case}");
        let exact = active_set::minimum(&problem);
        worst = worst.max((&x - &exact).amax());
        let free = problem.hessian.clone().cholesky().expect("damped").solve(problem.pull);
        limited += usize::from((free - exact).amax() > 1e-6);
        assert!(worst <= 1e-9, "case {case}: {worst}");
    }
    assert!(limited > 1000, "limits were in the way of {limited} steps only");
}

#[test]
fn no_answer_depends_on_the_questions_before_it() {
    let robot = ur5();
    let mut rng = generator(2, "near-singular");
    let mut reused = QuadraticProgram::new(6, 12);
    for _ in 0..200 {
        let owned = near_singular(&robot, &mut rng);
        let (mut a, mut b) = (DVector::zeros(6), DVector::zeros(6));
        reused.solve(&owned.problem(), &mut a);
        QuadraticProgram::new(6, 12).solve(&owned.problem(), &mut b);
        assert!(a == b, "{a} {b}");
    }
}

#[test]
fn a_program_allocates_nothing() {
    let robot = ur5();
    let mut rng = generator(3, "near-singular");
    let problems: Vec<_> = (0..50).map(|_| near_singular(&robot, &mut rng)).collect();
    let mut program = QuadraticProgram::new(6, 12);
    let mut x = DVector::zeros(6);
    assert!(program.solve(&problems[0].problem(), &mut x));
    let counted = allocation_counter::measure(|| {
        for owned in &problems {
            assert!(program.solve(&owned.problem(), &mut x));
        }
    });
    assert_eq!(counted.count_total, 0, "{counted:?}");
}

#[test]
fn a_descent_allocates_nothing_but_its_answer() {
    let robot = ur5();
    let near = [0.0, -1.5, 1.5, -1.5, -1.5, 0.0];
    let there = [0.3, -1.3, 1.2, -1.2, -1.2, 0.3];
    let target = robot.tool_pose(&there);
    let solver = QpIk::new(IkConfig { step_rad: 1.0, ..IkConfig::default() }, 1).expect("options");
    let query = IkQuery::continuous(&target, &near);
    let first = solver.solve(&robot, &query).expect("an answer");
    assert!(first.status == IkStatus::Solved && first.iterations >= 3, "{first:?}");
    let counted = allocation_counter::measure(|| {
        solver.solve(&robot, &query).expect("an answer");
    });
    assert_eq!(counted.count_total, 1, "{counted:?}");
}

#[test]
fn a_program_in_which_nothing_pulls_or_nothing_may_move_has_its_answer() {
    let robot = ur5();
    let owned = near_singular(&robot, &mut generator(4, "near-singular"));
    let (zero, away) = (DVector::zeros(6), DVector::repeat(6, 0.01));
    let mut program = QuadraticProgram::new(6, 12);
    let mut x = DVector::repeat(6, 1.0);
    assert!(program.solve(&Problem { pull: &zero, ..owned.problem() }, &mut x));
    assert!(x.amax() < 1e-12, "{x}");
    let still = Problem { lower: &zero, upper: &zero, ..owned.problem() };
    assert!(program.solve(&still, &mut x) && x == zero, "{x}");
    // Every joint has to go somewhere though nothing pulls.
    let far = DVector::repeat(6, 0.02);
    let (rows, bounds) = (DMatrix::zeros(12, 6), DVector::repeat(12, 1.0));
    let hessian = DMatrix::identity(6, 6);
    let forced = Problem {
        hessian: &hessian,
        pull: &zero,
        lower: &away,
        upper: &far,
        rows: &rows,
        bounds: &bounds,
    };
    assert!(program.solve(&forced, &mut x) && (&x - &away).amax() < 1e-12, "{x}");
}
