//! Free moves where the straight one is blocked.

#[path = "support/pairs.rs"]
mod pairs;

use pairs::{MARGINS, blocked, cell, ur5};
use seeone_collision::Checker;
use seeone_motion::{MotionConfig, Planner};
use seeone_plugin::Clearance;
use std::f64::consts::FRAC_PI_2;

#[test]
fn every_pair_at_its_nearest_turns_is_connected_without_contact() {
    let robot = ur5();
    let checker = Checker::new(&robot, MARGINS, &cell(), 0.05);
    let planner = Planner::new(MotionConfig::default(), 1).expect("options");
    for (index, [start, goal]) in blocked(&robot, &checker, true).iter().enumerate() {
        let path = planner.free_path(&robot, &checker, start, goal);
        let path = path.unwrap_or_else(|why| panic!("pair {index}: {why}"));
        assert!(path.len() > 2 && path.first() == Some(start) && path.last() == Some(goal));
        for ends in path.windows(2) {
            // Looked at in other places than the planner does.
            for k in 0..97 {
                let share = f64::from(k) / 97.0;
                let q: Vec<f64> =
                    ends[0].iter().zip(&ends[1]).map(|(a, b)| a + share * (b - a)).collect();
                let contact = checker.contact(&q);
                let deep = contact.filter(|found| found.distance_m < found.wanted_m - 0.005);
                assert!(deep.is_none(), "pair {index}: {deep:?}");
            }
        }
    }
}

/// Whether the upper arm would have to pass through the table: how low it reaches is a matter of
/// the shoulder's lift alone, which takes every value between its two ends on any path.
fn parted(checker: &Checker, from: f64, to: f64) -> bool {
    let mut between = (0..=200).map(|k| from + f64::from(k) / 200.0 * (to - from));
    between.any(|lift| {
        let contact = checker.contact(&[0.0, lift, 0.0, -FRAC_PI_2, 0.0, 0.0]);
        contact.is_some_and(|found| found.bodies == ["upper_arm_link", "table"])
    })
}

#[test]
fn of_goals_at_any_turn_those_without_a_path_are_on_the_other_side_of_the_table() {
    let robot = ur5();
    let checker = Checker::new(&robot, MARGINS, &cell(), 0.05);
    let planner = Planner::new(MotionConfig::default(), 1).expect("options");
    let mut without = 0;
    for [start, goal] in blocked(&robot, &checker, false) {
        let found = planner.free_path(&robot, &checker, &start, &goal).is_ok();
        assert!(found != parted(&checker, start[1], goal[1]), "{start:?} {goal:?}");
        without += usize::from(!found);
    }
    assert_eq!(without, 20);
}
