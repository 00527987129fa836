//! Which pairs of bodies always or never touch, found by sampling.

use crate::Placed;
use crate::body::{Body, bodies, pairs};
use seeone_core::random::{generator, uniform};
use seeone_core::robot::RobotModel;
use std::collections::BTreeMap;

/// Postures that are drawn for a robot file.
pub const SAMPLES: usize = 20_000;
/// A pair that was never nearer than this in any sample never touches, metres: postures
/// between the samples come a little nearer.
const NEVER_M: f64 = 0.01;

/// The pairs of URDF links of one robot that no check needs to look at.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Pairs {
    /// Touching at every posture.
    pub always: Vec<[String; 2]>,
    /// Apart at every posture.
    pub never: Vec<[String; 2]>,
}

/// The smallest and largest distance seen of two links.
struct Seen {
    least: f64,
    most: f64,
}

/// Draws `samples` postures and openings within the robot's limits and sorts the pairs that a
/// check would look at, in the order of the links.
pub fn sampled(robot: &RobotModel, samples: usize, seed: u64) -> Pairs {
    let mut rng = generator(seed, "collision-pairs");
    let mut seen: BTreeMap<(usize, usize), Seen> = BTreeMap::new();
    let order = names(&bodies(robot, 0.0));
    let index = |body: &Body| order.iter().position(|name| *name == body.name).unwrap_or(0);
    for _ in 0..samples {
        let draw = |j: &seeone_core::robot::Joint| uniform(&mut rng, j.lower(), j.upper());
        let q: Vec<f64> = robot.joints().iter().map(draw).collect();
        let bodies = bodies(robot, uniform(&mut rng, 0.0, robot.gripper().stroke_m()));
        let links = robot.forward(&q);
        let placed: Vec<Placed> = bodies.iter().map(|body| body.placed(&links)).collect();
        let mut nearest: BTreeMap<(usize, usize), f64> = BTreeMap::new();
        for (a, b) in pairs(robot, &bodies) {
            let distance = placed[a].distance(&placed[b]);
            let key = (index(&bodies[a]), index(&bodies[b]));
            let nearest = nearest.entry(key).or_insert(f64::INFINITY);
            *nearest = nearest.min(distance);
        }
        for (key, distance) in nearest {
            let seen =
                seen.entry(key).or_insert(Seen { least: f64::INFINITY, most: f64::NEG_INFINITY });
            *seen = Seen { least: seen.least.min(distance), most: seen.most.max(distance) };
        }
    }
    let which = |wanted: fn(&Seen) -> bool| {
        let some = seen.iter().filter(|(_, seen)| wanted(seen));
        some.map(|((a, b), _)| [order[*a].clone(), order[*b].clone()]).collect()
    };
    Pairs { always: which(|seen| seen.most <= 0.0), never: which(|seen| seen.least >= NEVER_M) }
}

/// The names of the bodies in their order, each once.
fn names(bodies: &[Body]) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for body in bodies {
        if !names.contains(&body.name) {
            names.push(body.name.clone());
        }
    }
    names
}
