//! The best that wearing can reach: a fine cap, let go where it belongs.

use nalgebra::Translation3;
use seeone_core::Pose;
use seeone_sim::category::cap::{Resolution, named_at};
use seeone_sim::expert::VisorGrasp;
use seeone_sim::worn::{template, worn};
use seeone_sim::{Hand, Head, Settings, Surroundings, World};

/// How far a worn cap is raised by the visor before it is put back, metres.
const RAISE_M: f64 = 0.02;
/// How far the fingers leave along their approach, metres.
const LEAVE_M: f64 = 0.18;

/// Mean distance of the vertices from the worn state in units of its diameter, after a grip
/// of the visor raised the cap, put it back and let go.
fn ceiling(substeps: usize) -> f64 {
    let cap = named_at("cap-unseen-07", Resolution::FINE).expect("a cap of this name");
    let settings = Settings { substeps, ..Settings::default() };
    let target = worn(&cap, &settings).expect("it sits");
    let head = Some(Head { pose: Pose::identity() });
    let surroundings = Surroundings { head, ..Surroundings::default() };
    let mut world = World::new(&cap, &template(&cap), surroundings, settings);
    world.set_vertices(&target.vertices).expect("as many, all finite");
    let tool = VisorGrasp::of(&cap, 0.0).expect("a visor to hold").tool_on(&target.vertices);
    let move_to = |world: &mut World, from: Pose, by: Translation3<f64>, opening_m: f64| {
        for frame in 1..=60 {
            let share = f64::from(frame) / 60.0;
            let step = Translation3::from(by.vector * (share * share * (3.0 - 2.0 * share)));
            world.move_hand(&Hand { pose: step * from, opening_m });
            world.advance();
        }
        by * from
    };
    world.move_hand(&Hand { pose: tool, opening_m: 0.03 });
    world.close(20.0);
    (0..30).for_each(|_| world.advance());
    let opening_m = world.hand().expect("a hand").opening_m;
    let up = Translation3::new(0.0, 0.0, RAISE_M);
    let raised = move_to(&mut world, tool, up, opening_m);
    let back = move_to(&mut world, raised, up.inverse(), opening_m);
    world.open(0.04);
    (0..30).for_each(|_| world.advance());
    let away = Translation3::from(back.rotation * nalgebra::Vector3::z() * -LEAVE_M);
    move_to(&mut world, back, away, 0.04);
    world.remove_hand();
    assert!(world.settle(6.0).at_rest, "{substeps} substeps: it does not come to rest");
    let apart = world.vertices().iter().zip(&target.vertices).map(|(a, b)| (a - b).norm());
    apart.sum::<f64>() / (target.vertices.len() as f64 * target.diameter_m)
}

#[test]
fn twice_the_substeps_give_the_same_ceiling() {
    let (coarse, fine) = (ceiling(20), ceiling(40));
    assert!(coarse < 0.02 && fine < 0.02, "{coarse} d at 20 substeps, {fine} d at 40");
    assert!((coarse - fine).abs() < 0.01, "{coarse} d at 20 substeps, {fine} d at 40");
}
