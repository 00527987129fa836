//! Caps dropped in seeded poses: how they come to rest.

#[allow(dead_code, reason = "the example reads more of an outcome")]
#[path = "common/drop_study.rs"]
mod drop_study;

use drop_study::{LIMIT_S, Outcome, one, study};
use rayon::prelude::*;
use seeone_sim::Settings;
use seeone_sim::category::cap::{self, Set};

/// Every eighth cap, five drops each; the example `drops` takes all.
#[test]
fn dropped_caps_come_to_rest_whole() {
    let names: Vec<String> = Set::DISJOINT.into_iter().flat_map(cap::names).step_by(8).collect();
    let outcomes: Vec<Outcome> = names
        .par_iter()
        .map(|name| cap::named(name).expect("a cap of this name"))
        .flat_map_iter(|cap| study(&cap, 5, &Settings::default()))
        .collect();
    let within = |limit: f64, rest_s: fn(&Outcome) -> Option<f64>| {
        let count = outcomes.iter().filter(|o| rest_s(o).is_some_and(|t| t <= limit)).count();
        count as f64 / outcomes.len() as f64
    };
    let shape = within(3.0, |o| o.shape_rest_s);
    assert!(shape >= 0.95, "{shape} have stopped deforming by 3 s");
    for o in &outcomes {
        let what = format!("{} drop {}", o.cap, o.drop);
        assert!(o.finite && o.lowest_m > -1e-4, "{what}: down to {} m", o.lowest_m);
        assert!(o.rest_s.is_some(), "{what} still moves at {} m/s after {LIMIT_S} s", o.speed_m_s);
        assert!(o.strain_p99 < 0.05, "{what}: strain {}", o.strain_p99);
        assert!(o.brim_deg < 2.0, "{what}: a brim bent by {} degrees", o.brim_deg);
        assert_eq!(o.crossings, 0, "{what} is tangled");
        let again = o.shape_again_m.expect("it settles on the head");
        assert!(again < 0.005, "{what}: worn again {again} m from its shape");
    }
}

/// A crease that was crumpled about one vertex (5 edges through triangles), one in which two
/// edges went through and came back again and again, and a fold in which the table pressed two
/// vertices together, so that they had a speed and stayed where they were.
#[test]
fn what_once_stayed_tangled_or_never_rested_rests_whole() {
    for (name, seed) in [("cap-train-012", 4), ("cap-train-054", 1), ("cap-train-057", 2)] {
        let cap = cap::named(name).expect("a cap of this name");
        let outcome = one(&cap, seed, &Settings::default(), None);
        assert!(outcome.rest_s.is_some(), "{name} drop {seed} never rests");
        assert_eq!(outcome.crossings, 0, "{name} drop {seed} is tangled");
    }
}
