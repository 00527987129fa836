//! Tries after the first: of what was missed, lost, or does not lie as it was shown.

use super::super::{Finished, Hooks, Outcome, Planned, Step, plan, run};
use super::{finished, names};
use crate::fakes::{Behaviour, FakeCell, leaning};
use crate::files::Stage;
use crate::transfer::{TILTS_DEG, turns};
use seeone_core::pose::difference;

/// A run of at most so many tries.
fn tried(cell: &FakeCell, behaviour: Behaviour, tries: usize) -> Finished {
    let mut assignment = cell.assignment();
    assignment.tries = tries;
    run(assignment, cell.plugins(behaviour), Hooks::default())
}

#[test]
fn a_hand_that_closed_on_nothing_goes_back_and_looks_again() {
    let cell = FakeCell::new();
    let tried = |misses: usize, tries: usize| {
        let mut assignment = cell.assignment();
        assignment.tries = tries;
        let behaviour = Behaviour { misses, ..Behaviour::default() };
        let mut now = 0.0;
        let clock = Box::new(move || {
            now += 0.5;
            now
        });
        run(assignment, cell.plugins(behaviour), Hooks { clock, ..Hooks::default() }).outcome
    };
    let once = tried(1, 3);
    assert_eq!((once.tries, once.success, once.failed_at.clone()), (2, Some(true), None));
    let one_try = ["observe", "perceive", "encode", "transfer", "plan", "pick"];
    let expected = [&one_try[..], &one_try[..], &["release", "judge"]].concat();
    assert_eq!(names(&once), expected);
    let missed = &once.stages[5];
    assert_eq!(
        (missed.ok, missed.reason.as_deref()),
        (false, Some("closed on nothing, at 0.0 mm"))
    );
    assert_eq!(once.timings_ms.len(), 7);
    assert!(once.timings_ms.contains(&(Step::Plan, 1000.0)), "times of both tries are added");
    // Approach, grip, open, and the approach again, backwards.
    assert!((missed.seconds - 4.0).abs() < 0.05, "{}", missed.seconds);

    let always = tried(9, 3);
    assert_eq!((always.tries, always.success), (3, Some(false)));
    assert_eq!(always.failed_at.as_deref(), Some("pick"));
    assert_eq!(always.reason, "pick: closed on nothing, at 0.0 mm");
}

#[test]
fn a_hand_that_closed_on_nothing_opens_wider_as_far_as_it_can() {
    let cell = FakeCell::new();
    let opened = |misses: usize| {
        let finished = tried(&cell, Behaviour { misses, ..Behaviour::default() }, 9);
        finished.left::<Planned>().expect("a plan").key_poses[0].opening_m
    };
    let widest_m = cell.assignment().robot.gripper().stroke_m();
    let shown_m = opened(0);
    assert_eq!(shown_m, cell.assignment().skill.stages[0].opening_m);
    for (misses, times) in [(1, 1.5), (2, 2.0), (8, 5.0)] {
        assert!((opened(misses) - (times * shown_m).min(widest_m)).abs() < 1e-12);
    }
}

#[test]
fn a_hand_that_has_no_way_along_the_surface_comes_from_above_it() {
    let cell = FakeCell::new();
    let turns = turns(90.0, 0.0).len();
    let tilt = |refuses: usize| {
        let finished = finished(&cell, Behaviour { refuses, ..Behaviour::default() });
        finished.left::<Planned>().map(|planned| planned.turn.tilt_deg)
    };
    let shares = plan::RETREAT_SHARES.len();
    assert_eq!((tilt(0), tilt(turns * shares - 1)), (Some(0.0), Some(0.0)));
    assert_eq!(tilt(turns * shares), Some(TILTS_DEG[1]));
    assert_eq!(tilt(turns * shares * TILTS_DEG.len()), None);
}

#[test]
fn what_does_not_lie_as_it_was_shown_is_taken_again() {
    let cell = FakeCell::with_result();
    let fallen = |falls: usize, tries: usize| {
        tried(&cell, Behaviour { falls, ..Behaviour::default() }, tries).outcome
    };
    let checks = |outcome: &Outcome| {
        let checks = outcome.stages.iter().filter(|stage| stage.name == "check");
        checks.map(|stage| stage.ok).collect::<Vec<_>>()
    };
    let at_once = fallen(0, 3);
    assert_eq!((at_once.tries, at_once.as_shown, checks(&at_once)), (1, Some(true), vec![true]));
    let told = at_once.stages.iter().find(|stage| stage.name == "check").unwrap();
    assert_eq!(told.reason.as_deref(), Some("10 mm and 0 degrees from where it was shown"));
    let second = fallen(1, 3);
    assert_eq!((second.tries, second.as_shown), (2, Some(true)));
    assert_eq!(checks(&second), [false, true]);
    // What the robot believes decides no verdict.
    let never = fallen(9, 2);
    assert_eq!((never.tries, never.as_shown, never.success), (2, Some(false), Some(true)));
    assert_eq!((checks(&never), never.failed_at), (vec![false, false], None));
}

#[test]
fn what_lies_where_it_was_to_be_but_leans_is_set_right_there() {
    let mut cell = FakeCell::with_result();
    let place = Stage { gripper: None, retreat_m: 0.0, ..cell.skill.stages[1].clone() };
    cell.skill.stages.insert(1, Stage { name: "place".into(), ..place });
    let head = cell.assignment().frames["head"];
    let behaviour = Behaviour { leans_deg: 12.0, ..Behaviour::default() };
    let finished = tried(&cell, behaviour, 2);
    let outcome = &finished.outcome;
    let told: Vec<_> = outcome.stages.iter().map(|s| (s.name.as_str(), s.ok)).collect();
    assert!(told.contains(&("check", false)) && told.contains(&("right", true)), "{told:?}");
    assert_eq!((outcome.tries, outcome.as_shown), (2, Some(true)));
    let key_poses = &finished.left::<Planned>().unwrap().key_poses;
    let [taken, right, release] = &key_poses[..] else { panic!("{key_poses:?}") };
    assert_eq!((taken.lift_m, right.gripper, release.stage.as_str()), (0.0, None, "release"));
    let turned = head * leaning(-12.0) * head.inverse() * taken.pose;
    for key in [right, release] {
        let (metres, radians) = difference(&key.pose, &turned);
        assert!(metres < 1e-6 && radians < 1e-6, "{}: {metres} {radians}", key.stage);
    }
    // Where there is no way to set it right, all of it is done again.
    let behaviour = Behaviour { unreachable: Some("right"), ..behaviour };
    let outcome = tried(&cell, behaviour, 2).outcome;
    assert_eq!(names(&outcome).iter().filter(|name| **name == "place").count(), 2);
}

#[test]
fn what_was_lost_on_the_way_is_taken_again() {
    let cell = FakeCell::new();
    let outcome = tried(&cell, Behaviour { drops: true, ..Behaviour::default() }, 2).outcome;
    let one_try = ["observe", "perceive", "encode", "transfer", "plan", "pick"];
    let expected = [&one_try[..], &["withdraw"], &one_try[..], &["judge"]].concat();
    assert_eq!((outcome.tries, names(&outcome)), (2, expected));
    assert_eq!(outcome.reason, "pick: lost the object on the way (lift)");
    // What is kept of it is read again to the same bytes, the way back included.
    let kept = serde_json::to_string(&outcome).unwrap();
    assert!(kept.contains("\"withdraw\":"), "{kept}");
    let read: Outcome = serde_json::from_str(&kept).unwrap();
    assert_eq!(serde_json::to_string(&read).unwrap(), kept);
}
