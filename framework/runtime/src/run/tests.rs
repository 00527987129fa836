#![allow(clippy::unwrap_used, reason = "tests")]

mod again;

use super::bench::UNREACHABLE;
use super::*;
use crate::fakes::{Behaviour, FakeCell};
use crate::files::Stage;
use crate::record::{Channel, read};
use crate::transfer::ANCHOR;
use bevy_ecs::schedule::{LogLevel, ScheduleBuildSettings};
use bevy_ecs::world::World;
use nalgebra::{Point3, Vector3};
use std::cell::RefCell;
use std::fs;
use std::rc::Rc;

fn finished(cell: &FakeCell, behaviour: Behaviour) -> Finished {
    let mut assignment = cell.assignment();
    assignment.seed = 7;
    assignment.recording = Some(cell.folder.path().join("run.mcap"));
    run(assignment, cell.plugins(behaviour), Hooks::default())
}

fn names(outcome: &Outcome) -> Vec<&str> {
    outcome.stages.iter().map(|stage| stage.name.as_str()).collect()
}

#[test]
fn the_steps_have_an_order_and_none_is_ambiguous() {
    for mut schedule in [schedule::attempt(), schedule::conclude()] {
        schedule.set_build_settings(ScheduleBuildSettings {
            ambiguity_detection: LogLevel::Error,
            ..Default::default()
        });
        schedule.initialize(&mut World::new()).unwrap();
    }
}

#[test]
fn a_run_goes_from_a_look_to_a_verdict() {
    let cell = FakeCell::new();
    let outcome = finished(&cell, Behaviour::default()).outcome;
    assert_eq!(
        names(&outcome),
        ["observe", "perceive", "encode", "transfer", "plan", "pick", "release", "judge", "record"]
    );
    assert!(outcome.stages.iter().all(|stage| stage.ok && stage.reason.is_none()));
    assert_eq!((outcome.grasped, outcome.success), (Some(true), Some(true)));
    assert_eq!(outcome.reason, "worn within 0.04 d");
    assert_eq!(outcome.error_d, Some(0.04));
    let json = serde_json::to_value(&outcome).unwrap();
    assert_eq!(json["seed"], 7);
    assert_eq!(json["object"], "fake-cap");
    assert_eq!(json["methods"]["motion"], "fake");
    assert!(json["timings_ms"]["transfer"].is_number());
    assert_eq!(json["stages"][5]["name"], "pick");
}

#[test]
fn the_planner_is_told_of_what_was_seen_where_the_hand_will_have_it() {
    let cell = FakeCell::new();
    let finished = finished(&cell, Behaviour::default());
    let planned = finished.left::<Planned>().unwrap();
    let seen = finished.left::<Seen>().unwrap().0.cloud.clone();
    assert!((20..=128).contains(&planned.carried.len()), "{}", planned.carried.len());
    let there = planned.carried.iter().map(|point| planned.key_poses[0].pose * point);
    for point in there {
        let miss = |other: &Point3<f64>| (other - point).norm();
        assert!(seen.points().iter().map(miss).fold(f64::INFINITY, f64::min) < 1e-9);
    }
}

#[test]
fn the_grasp_and_the_release_are_where_the_demonstration_says() {
    let cell = FakeCell::new();
    let finished = finished(&cell, Behaviour::default());
    let transferred = finished.left::<Transferred>().unwrap();
    let grasp = &transferred.grasps[0];
    let tip = cell.placed[1] * Point3::new(0.5, 0.95, 0.35);
    assert!((grasp.tool.translation.vector - tip.coords).norm() < 1e-6);
    let approach = grasp.tool.rotation * Vector3::z();
    let wanted = cell.placed[1].isometry.rotation * -Vector3::y();
    assert!((approach - wanted).norm() < 1e-6);
    assert!((grasp.held.scale - 0.29).abs() < 1e-9);
    assert!((transferred.demonstrated.scale - 0.27).abs() < 1e-9);

    // Cheapest in the fake motion is the turn that points the tool downward most; but the
    // hand is turned as little as will do, here not at all, and the cap comes level onto the
    // moved head.
    let planned = finished.left::<Planned>().unwrap();
    assert_eq!(planned.turn.about_closing_deg, 0.0);
    let release = planned.key_poses[1].pose * planned.turn.pose().inverse();
    let up = release.rotation * grasp.candidate.pose.rotation.inverse() * Vector3::z();
    assert!((up - Vector3::z()).norm() < 1e-6, "{up}");
    let held = &grasp.held;
    let back = release.rotation
        * held.tool.rotation.inverse()
        * (ANCHOR - Point3::from(held.tool.translation.vector))
        * held.scale
        + release.translation.vector;
    let shown =
        Vector3::new(0.1, 0.5, 0.3) + Vector3::new(-0.135, -0.135, -0.07) + ANCHOR.coords * 0.27;
    assert!((back - shown).norm() < 1e-6, "{back} {shown}");
}

#[test]
fn a_step_that_fails_ends_the_run_but_not_its_verdict_and_recording() {
    let cell = FakeCell::new();
    let steps = ["observe", "perceive", "encode", "transfer", "plan"];
    for (index, step) in steps.into_iter().enumerate() {
        for panics in [false, true] {
            let behaviour = Behaviour { fails: Some(step), panics, ..Behaviour::default() };
            let finished = finished(&cell, behaviour);
            let outcome = finished.outcome;
            assert!(outcome.reason.starts_with(&format!("{step}: ")), "{}", outcome.reason);
            assert!(outcome.reason.contains(&format!("broken {step}")), "{}", outcome.reason);
            assert_eq!(outcome.reason.contains("panicked"), panics);
            assert_eq!((outcome.grasped, outcome.success), (Some(false), Some(false)));
            let expected: Vec<&str> =
                steps[..=index].iter().copied().chain(["judge", "record"]).collect();
            assert_eq!(names(&outcome), expected);
            assert!(!outcome.stages[index].ok);
            let recording = read(&outcome.recording.unwrap()).unwrap();
            let verdict = recording.of(Channel::Verdict).next().unwrap();
            assert_eq!(verdict.body["grasped"], false);
            assert!(verdict.body["reason"].as_str().unwrap().starts_with(step));
        }
    }
}

#[test]
fn what_the_gripper_feels_ends_the_run() {
    let cell = FakeCell::new();
    let cases = [
        (Behaviour { misses: 1, ..Behaviour::default() }, "pick: closed on nothing, at 0.0 mm"),
        (
            Behaviour { drops: true, ..Behaviour::default() },
            "pick: lost the object on the way (lift)",
        ),
        (
            Behaviour { fails: Some("act"), ..Behaviour::default() },
            "pick: internal fault: broken act",
        ),
    ];
    for (behaviour, reason) in cases {
        let outcome = finished(&cell, behaviour).outcome;
        assert_eq!(outcome.reason, reason);
        assert_eq!((outcome.grasped, outcome.success), (Some(false), Some(false)));
        assert_eq!(names(&outcome)[5..], ["pick", "judge", "record"]);
    }
}

#[test]
fn contact_ends_a_line_and_the_rest_is_planned_from_there() {
    let mut cell = FakeCell::new();
    cell.skill.stages[1].until_contact_n = Some(20.0);
    let behaviour = Behaviour { touches: true, ..Behaviour::default() };
    let finished = finished(&cell, behaviour);
    let outcome = &finished.outcome;
    assert_eq!((outcome.success, outcome.failed_at.clone()), (Some(true), None));
    let release = outcome.stages.iter().find(|stage| stage.name == "release").unwrap();
    let note = release.reason.as_deref().unwrap();
    assert!(release.ok && note.starts_with("contact ") && note.ends_with(" mm before the pose"));
    // Approach as planned, then approach, grip and retreat of the new plan, which the fake
    // makes only for a hand that holds something.
    assert!((release.seconds - 4.0).abs() < 0.05, "{}", release.seconds);
    let slips = Behaviour { slips: true, ..behaviour };
    let slipped = self::finished(&cell, slips).outcome;
    assert_eq!((slipped.success, slipped.failed_at), (Some(true), None));
    let release = slipped.stages.iter().find(|stage| stage.name == "release").unwrap();
    assert!(release.reason.as_deref().unwrap().starts_with("pushed out of the hand "));
    let behaviour = Behaviour { blocks_after: Some("release"), ..behaviour };
    let outcome = self::finished(&cell, behaviour).outcome;
    assert_eq!(
        outcome.reason,
        "release: felt contact, and there is no way on from there: release: 0.30 m out of reach"
    );
}

#[test]
fn what_was_pushed_out_before_it_was_to_be_let_go_is_let_go_there() {
    let mut cell = FakeCell::new();
    let release = &cell.skill.stages[1];
    let mut feel = release.clone();
    (feel.name, feel.gripper, feel.retreat_m) = ("feel".into(), None, 0.0);
    feel.until_contact_n = Some(10.0);
    let press = Stage { until_contact_n: Some(20.0), onward: true, ..release.clone() };
    cell.skill.stages.splice(1.., [feel, press]);
    let behaviour = Behaviour { touches: true, slips: true, ..Behaviour::default() };
    let outcome = finished(&cell, behaviour).outcome;
    assert_eq!((outcome.success, outcome.failed_at.clone()), (Some(true), None), "{outcome:?}");
    let told = outcome.stages.iter().find(|stage| stage.name == "feel").unwrap();
    assert!(told.reason.as_deref().unwrap().starts_with("pushed out of the hand "));
}

#[test]
fn a_robot_that_panics_is_a_failure() {
    let cell = FakeCell::new();
    let behaviour = Behaviour { fails: Some("act"), panics: true, ..Behaviour::default() };
    let outcome = finished(&cell, behaviour).outcome;
    assert_eq!(outcome.reason, "act: a plugin panicked: broken act");
}

#[test]
fn nothing_in_sight_and_nothing_in_reach_are_told() {
    let cell = FakeCell::new();
    let outcome = finished(&cell, Behaviour { blind: true, ..Behaviour::default() }).outcome;
    assert_eq!(outcome.reason, "observe: nothing of the object is in sight");
    let behaviour = Behaviour { unreachable: Some("release"), ..Behaviour::default() };
    assert_eq!(
        finished(&cell, behaviour).outcome.reason,
        "plan: none of 26 ways to grasp can be carried out; the nearest fails at release: \
         0.30 m out of reach"
    );
}

#[test]
fn a_judge_that_fails_leaves_no_verdict() {
    let cell = FakeCell::new();
    let behaviour = Behaviour { fails: Some("judge"), ..Behaviour::default() };
    let outcome = finished(&cell, behaviour).outcome;
    assert_eq!((outcome.grasped, outcome.success), (None, None));
    assert_eq!(outcome.reason, "judge: internal fault: broken judge");
}

#[test]
fn a_dry_run_plans_and_does_not_move() {
    let cell = FakeCell::new();
    let mut assignment = cell.assignment();
    assignment.dry_run = true;
    let finished = run(assignment, cell.plugins(Behaviour::default()), Hooks::default());
    assert!(finished.left::<Planned>().is_some() && finished.left::<Acted>().is_none());
    let outcome = finished.outcome;
    assert_eq!(outcome.reason, "planned, not carried out");
    assert_eq!((outcome.grasped, outcome.success, outcome.recording), (None, None, None));
}

#[test]
fn a_cell_that_nobody_can_judge_says_so() {
    let cell = FakeCell::new();
    let mut plugins = cell.plugins(Behaviour::default());
    plugins.judge = None;
    let outcome = run(cell.assignment(), plugins, Hooks::default()).outcome;
    assert_eq!(outcome.success, None);
    assert_eq!(outcome.reason, "carried out; nobody can judge this cell");
}

#[test]
fn steps_are_told_as_they_end_and_timed_by_the_given_clock() {
    let cell = FakeCell::new();
    let told = Rc::new(RefCell::new(Vec::new()));
    let (telling, mut now) = (Rc::clone(&told), 0.0);
    let hooks = Hooks {
        clock: Box::new(move || {
            now += 0.5;
            now
        }),
        progress: Box::new(move |event| telling.borrow_mut().push(event.clone())),
        cancel: Cancel::default(),
    };
    let outcome = run(cell.assignment(), cell.plugins(Behaviour::default()), hooks).outcome;
    assert_eq!(*told.borrow(), outcome.stages);
    assert!(outcome.timings_ms.iter().all(|(_, ms)| (ms - 500.0).abs() < 1e-9));
    let seconds =
        |name: &str| outcome.stages.iter().find(|stage| stage.name == name).unwrap().seconds;
    assert_eq!(seconds("plan"), 0.5);
    // Approach, grip and lift take the fake robot a second each.
    assert!((seconds("pick") - 3.0).abs() < 0.05, "{}", seconds("pick"));
}

/// A run that is interrupted as soon as `step` is told.
fn interrupted(cell: &FakeCell, behaviour: Behaviour, step: &'static str) -> Outcome {
    let (cancel, mut assignment) = (Cancel::default(), cell.assignment());
    assignment.recording = Some(cell.folder.path().join("a.mcap"));
    let ordered = cancel.clone();
    let progress = Box::new(move |event: &StageEvent| {
        if event.name == step {
            ordered.order();
        }
    });
    let hooks = Hooks { progress, cancel, ..Hooks::default() };
    run(assignment, cell.plugins(behaviour), hooks).outcome
}

#[test]
fn a_run_that_is_interrupted_begins_nothing_more_and_is_recorded() {
    let cell = FakeCell::new();
    for (step, failed_at) in
        [("observe", "perceive"), ("plan", "act"), ("pick", "release"), ("release", "judge")]
    {
        let outcome = interrupted(&cell, Behaviour::default(), step);
        assert_eq!(outcome.reason, format!("{failed_at}: interrupted"));
        assert_eq!(outcome.success, None, "nobody waits for a verdict");
        let last = &outcome.stages[outcome.stages.len() - 1];
        assert_eq!((last.name.as_str(), last.ok), ("record", true));
        read(&outcome.recording.expect("a recording")).unwrap();
    }
}

#[test]
fn the_robot_is_stopped_when_a_run_fails_and_told_of_when_it_does_not_answer() {
    let cell = FakeCell::new();
    let deaf = Behaviour { fails: Some("stop"), ..Behaviour::default() };
    let told = |outcome: &Outcome| {
        let stop = outcome.stages.iter().find(|stage| stage.name == "stop");
        stop.and_then(|stop| stop.reason.clone())
    };
    let expected = Some(format!("{UNREACHABLE}: internal fault: broken stop"));
    let missed = finished(&cell, Behaviour { misses: 9, ..deaf }).outcome;
    assert_eq!(missed.failed_at.as_deref(), Some("pick"));
    assert_eq!(told(&missed), expected);
    assert_eq!(told(&interrupted(&cell, deaf, "pick")), expected);
    let panicking = finished(&cell, Behaviour { misses: 9, panics: true, ..deaf }).outcome;
    let expected = Some(format!("{UNREACHABLE}: a plugin panicked: broken stop"));
    assert_eq!(told(&panicking), expected);
    assert_eq!(told(&finished(&cell, deaf).outcome), None, "nothing failed");
}

#[test]
fn the_same_run_gives_the_same_bytes() {
    let record = || {
        let cell = FakeCell::new();
        let mut assignment = cell.assignment();
        let path = cell.folder.path().join("a.mcap");
        assignment.recording = Some(path.clone());
        let mut now = 0.0;
        let clock = Box::new(move || {
            now += 0.123;
            now
        });
        let hooks = Hooks { clock, ..Hooks::default() };
        let outcome = run(assignment, cell.plugins(Behaviour::default()), hooks).outcome;
        assert_eq!(outcome.success, Some(true));
        fs::read(path).unwrap()
    };
    let first = record();
    for _ in 0..3 {
        assert!(first == record(), "a recording differs from that of the same run");
    }
}

#[test]
fn a_scene_without_the_frame_of_a_stage_is_refused() {
    let cell = FakeCell::new();
    let assignment = cell.assignment();
    let mut skill = cell.skill.clone();
    skill.stages[1].relative_to = crate::files::RelativeTo::Frame("hook".into());
    let refused = Assignment::new(
        skill,
        cell.scene.clone(),
        assignment.robot.clone(),
        assignment.methods.clone(),
    );
    assert_eq!(refused.unwrap_err().code, "M005");
}
