//! The best that wearing can reach: fine caps, let go where they belong.

use rayon::prelude::*;
use seeone_core::Pose;
use seeone_sim::category::cap::{Resolution, named_at};
use seeone_sim::put_on::{Misplacement, put_on};
use seeone_sim::wearing::WearError;
use seeone_sim::worn::worn;
use seeone_sim::{Head, Settings};

const CAPS: [&str; 4] = ["cap-unseen-00", "cap-unseen-04", "cap-unseen-08", "cap-unseen-11"];
/// The world's default, and twice as many.
const SUBSTEPS: [usize; 2] = [40, 80];

/// Mean distance of the vertices from the worn state in units of its diameter, after a hand
/// put the cap on without any error.
fn ceiling(name: &str, substeps: usize) -> f64 {
    let cap = named_at(name, Resolution::FINE).expect("a cap of this name");
    let settings = Settings { substeps, ..Settings::default() };
    let worn = worn(&cap, &settings).expect("it sits");
    let head = Head::medium(Pose::translation(0.0, 0.0, 0.3));
    let end = put_on(&cap, &worn, head, &Misplacement::none(), &settings);
    assert!(end.settled.at_rest, "{name}, {substeps} substeps: it does not come to rest");
    WearError::of(&worn, &end.reached(&head)).mean_d
}

#[test]
fn twice_the_substeps_give_the_same_ceiling() {
    let ceilings: Vec<[f64; 2]> =
        CAPS.par_iter().map(|name| SUBSTEPS.map(|substeps| ceiling(name, substeps))).collect();
    for (name, [coarse, fine]) in CAPS.iter().zip(ceilings) {
        assert!(
            coarse < 0.02 && fine < 0.02,
            "{name}: {coarse} d, {fine} d with twice the substeps"
        );
        assert!(
            (coarse - fine).abs() < 0.01,
            "{name}: {coarse} d, {fine} d with twice the substeps"
        );
    }
}
