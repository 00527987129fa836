//! Free moves where the straight one is blocked.

#[path = "support/pairs.rs"]
mod pairs;

use pairs::{MARGINS, PAIRS, blocked, cell, ur5};
use seeone_collision::Checker;
use seeone_motion::{MotionConfig, Planner};
use seeone_plugin::Clearance;

#[test]
fn every_pair_that_the_table_does_not_part_is_connected_without_contact() {
    let robot = ur5();
    let checker = Checker::new(&robot, MARGINS, &cell(), 0.05);
    let planner = Planner::new(MotionConfig::default(), 1).expect("options");
    let (pairs, _) = blocked(&robot, &checker);
    assert_eq!(pairs.len(), PAIRS);
    for (index, [start, goal]) in pairs.iter().enumerate() {
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
