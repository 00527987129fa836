//! The suite catches plugins that break its rules.

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion};
use seeone_core::Similarity;
use seeone_core::robot::RobotModel;
use seeone_plugin::conformance::Descent;
use seeone_plugin::{
    Alignment, AlignmentOutcome, Candidate, Correspondences, IkOutcome, IkQuery, IkStatus,
    Kinematics, PluginError, Transfer, TransferTask, conformance,
};
use std::sync::atomic::{AtomicU64, Ordering};

/// What is wrong with an alignment that is otherwise exact on exact pairs.
#[derive(Clone, Copy, PartialEq)]
enum Fault {
    ForgetsFixedScale,
    ChangesItsMind,
    AnswersAnything,
    StaysPut,
}

/// Reads the transform off three pairs by their triangle's frame; no solver, but exact.
struct Faulty(Fault, AtomicU64);

impl Faulty {
    fn new(fault: Fault) -> Self {
        Self(fault, AtomicU64::new(0))
    }
}

/// Three of the points, far apart where there are many.
fn corners(points: &[Point3<f64>]) -> [Point3<f64>; 3] {
    let n = points.len();
    [points[0], points[(n / 4).max(1)], points[(n / 2).max(2)]]
}

fn frame(points: &[Point3<f64>]) -> Isometry3<f64> {
    let [a, b, c] = corners(points);
    Isometry3::from_parts(
        Translation3::from(a.coords),
        UnitQuaternion::face_towards(&(b - a), &(c - a)),
    )
}

impl Alignment for Faulty {
    fn align(&self, pairs: &Correspondences) -> Result<AlignmentOutcome, PluginError> {
        if self.0 != Fault::AnswersAnything || pairs.source.len() < 41 {
            pairs.check()?;
        }
        let side = |p: &[Point3<f64>]| {
            let [a, b, _] = corners(p);
            (b - a).norm()
        };
        let mut scale = side(pairs.target) / side(pairs.source);
        if self.0 != Fault::ForgetsFixedScale {
            scale = pairs.fixed_scale.unwrap_or(scale);
        }
        let (from, to) = (frame(pairs.source), frame(pairs.target));
        let rotation = to.rotation * from.rotation.inverse();
        let centre = rotation * from.translation.vector * scale;
        let mut shift = to.translation.vector - centre;
        if self.0 == Fault::StaysPut {
            shift.fill(0.0);
        }
        let transform = Similarity::from_parts(shift.into(), rotation, scale);
        let calls = self.1.fetch_add(1, Ordering::Relaxed);
        let residual = if self.0 == Fault::ChangesItsMind { calls as f64 } else { 0.0 };
        Ok(AlignmentOutcome { transform, residual, inlier_share: 1.0, condition: 1.0 })
    }
}

#[test]
fn faulty_alignments_are_caught_by_the_rule_they_break() {
    for (fault, rule) in [
        (Fault::ForgetsFixedScale, "a fixed scale is kept to the bit"),
        (Fault::ChangesItsMind, "the same input gives the same bytes"),
        (Fault::AnswersAnything, "a missing target is refused"),
        (Fault::StaysPut, "an exact similarity is found"),
    ] {
        let caught = conformance::alignment(&Faulty::new(fault)).expect_err(rule);
        assert_eq!(caught.rule, rule, "{caught}");
    }
}

/// A transfer that answers what its function says.
struct Says(fn(&TransferTask) -> Result<Vec<Candidate>, PluginError>);

impl Transfer for Says {
    fn transfer(&self, task: &TransferTask) -> Result<Vec<Candidate>, PluginError> {
        (self.0)(task)
    }
}

fn kept(task: &TransferTask, confidence: f64) -> Vec<Candidate> {
    vec![Candidate {
        pose: *task.demonstrated,
        loss: 0.0,
        confidence,
        lay_on_surface: false,
        origin: "kept".into(),
    }]
}

#[test]
fn faulty_transfers_are_caught_by_the_rule_they_break() {
    let says: [(&str, Says); 4] = [
        ("there is always a candidate", Says(|task| task.check().map(|()| Vec::new()))),
        (
            "finite in, finite and within its range out",
            Says(|task| task.check().map(|()| kept(task, 1.5))),
        ),
        ("an empty cloud is refused", Says(|task| Ok(kept(task, 0.5)))),
        (
            "the demonstrated pose on the demonstrated object is kept",
            Says(|task| {
                task.check()?;
                let mut found = kept(task, 0.5);
                found[0].pose.translation.z += 0.05;
                Ok(found)
            }),
        ),
    ];
    for (rule, plugin) in says {
        let caught = conformance::transfer(&plugin).expect_err(rule);
        assert_eq!(caught.rule, rule, "{caught}");
    }
    conformance::transfer(&Says(|task| task.check().map(|()| kept(task, 0.5)))).expect("conforms");
}

/// What is made of an outcome.
type Alter = fn(&mut IkOutcome);

/// Kinematics that alter what the suite's own answer.
struct Altered(Alter);

impl Kinematics for Altered {
    fn solve(&self, robot: &RobotModel, query: &IkQuery) -> Result<IkOutcome, PluginError> {
        let mut outcome = Descent::default().solve(robot, query)?;
        (self.0)(&mut outcome);
        Ok(outcome)
    }
}

#[test]
fn dishonest_kinematics_are_caught_by_the_rule_they_break() {
    let cases: [(&str, Alter); 5] = [
        ("what is near is reached", |o| o.status = IkStatus::Infeasible),
        ("what is out of reach is infeasible, with a reason", |o| o.status = IkStatus::Solved),
        ("finite in, finite and within the limits out", |o| o.joints[2] = 9.0),
        ("the errors that are told are those of the joints", |o| o.position_error_m += 0.1),
        ("what is out of reach is infeasible, with a reason", |o| o.reason = None),
    ];
    for (rule, alter) in cases {
        let caught = conformance::kinematics(&Altered(alter)).expect_err(rule);
        assert_eq!(caught.rule, rule, "{caught}");
    }
}
