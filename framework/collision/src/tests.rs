#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use nalgebra::{Point3, Vector3};
use seeone_core::Pose;
use seeone_core::random::{generator, uniform};
use seeone_core::robot::{RobotModel, RobotOptions, Shape, Solid};
use seeone_plugin::motion::Obstacle;
use seeone_plugin::{Clearance, Proximity};
use std::path::Path;

const HOME: [f64; 6] = [0.0, -1.9, 1.4, -1.05, -1.57, 0.0];

fn ur5() -> RobotModel {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/ur5-ag95.urdf");
    RobotModel::from_urdf(&file, &RobotOptions::default()).unwrap()
}

fn checker<'a>(robot: &'a RobotModel, obstacles: &[Obstacle]) -> Checker<'a> {
    let margins = Margins { clearance_m: 0.005, carried_m: 0.03 };
    Checker::new(robot, margins, obstacles, 0.05)
}

fn post(x: f64, y: f64) -> Obstacle {
    Obstacle::Solid(Solid {
        part: "post".into(),
        shape: Shape::Box { half_m: Vector3::new(0.02, 0.02, 0.6) },
        pose: Pose::translation(x, y, 0.6),
    })
}

#[test]
fn a_folded_arm_names_the_pair_and_how_deep_it_is() {
    let robot = ur5();
    assert_eq!(checker(&robot, &[]).contact(&HOME), None);
    // The forearm lies on the upper arm, the wrist in the shoulder.
    let contact = checker(&robot, &[]).contact(&[0.0, -1.5, 3.1, 0.0, 0.0, 0.0]).unwrap();
    assert!(contact.distance_m <= 0.0 && contact.wanted_m == 0.0, "{contact:?}");
    let links: Vec<&str> =
        robot.links().iter().flat_map(|l| &l.collision).map(|s| s.part.as_str()).collect();
    let hand = ["ag95_palm", "ag95_left_finger", "ag95_right_finger"];
    let known = |name: &String| links.contains(&name.as_str()) || hand.contains(&name.as_str());
    assert!(contact.bodies.iter().all(known), "{contact:?}");
    assert!(contact.to_string().contains("mm too near to"), "{contact}");
}

#[test]
fn an_obstacle_is_kept_away_from_by_the_margin() {
    let robot = ur5();
    let tool = robot.tool_pose(&HOME).translation.vector;
    let reach = robot.gripper().reach_m(0.05) - 0.190;
    // A plate under the finger tips.
    let plate = |gap: f64| {
        Obstacle::Solid(Solid {
            part: "plate".into(),
            shape: Shape::Box { half_m: Vector3::new(0.2, 0.2, 0.01) },
            pose: Pose::translation(tool.x, tool.y, tool.z - reach - gap - 0.01),
        })
    };
    assert_eq!(checker(&robot, &[plate(0.0075)]).contact(&HOME), None);
    let contact = checker(&robot, &[plate(0.002)]).contact(&HOME).unwrap();
    assert!(contact.bodies[0].contains("finger"), "{contact}");
    assert_eq!(contact.bodies[1], "plate");
    assert!(contact.distance_m < 0.005 && contact.wanted_m == 0.005, "{contact:?}");
}

#[test]
fn what_is_carried_keeps_away_as_well() {
    let robot = ur5();
    let tool = robot.tool_pose(&HOME).translation.vector;
    let obstacles = [post(tool.x + 0.12, tool.y)];
    assert_eq!(checker(&robot, &obstacles).contact(&HOME), None);
    let brim = [(0.15, 0.0), (-0.15, 0.0), (0.0, 0.15), (0.0, -0.15)];
    let cap = Convex::hull(&brim.map(|(x, y)| Point3::new(x, y, 0.05))).unwrap();
    let contact = checker(&robot, &obstacles).carrying(cap).contact(&HOME).unwrap();
    assert_eq!(contact.bodies, ["held", "post"]);
    assert_eq!(Convex::hull(&[]), None);
}

/// A proximity's gradient is the derivative of its margin: moving by it, the margin changes by
/// what the two points' velocities along the normal say.
#[test]
fn proximities_are_the_near_pairs_and_their_points_move_with_the_links() {
    let robot = ur5();
    let obstacles = [Obstacle::Table { height_m: 0.0, soft_m: 0.0 }, post(0.6, 0.0)];
    let checker = checker(&robot, &obstacles);
    let mut rng = generator(3, "proximities");
    let (mut found, mut after) = (Vec::new(), Vec::new());
    let mut compared = 0;
    for _ in 0..200 {
        let q: Vec<f64> =
            robot.joints().iter().map(|j| uniform(&mut rng, j.lower(), j.upper())).collect();
        checker.proximities(&q, 0.1, &mut found);
        assert!(found.is_sorted_by(|a, b| a.margin_m <= b.margin_m));
        let step: Vec<f64> = q.iter().map(|q| q + uniform(&mut rng, -1e-6, 1e-6)).collect();
        checker.proximities(&step, 0.1, &mut after);
        let Some(nearest) = found.iter().find(|near| near.margin_m > 0.0) else { continue };
        let (before, moved) = (robot.forward(&q), robot.forward(&step));
        let predicted = rate(nearest, &before, &moved);
        let same = |near: &&Proximity| {
            near.carriers.map(|c| c.map(|c| c.0)) == nearest.carriers.map(|c| c.map(|c| c.0))
                && (near.margin_m - nearest.margin_m - predicted).abs() < 1e-8
        };
        assert!(after.iter().any(|near| same(&near)), "{nearest:?} {predicted}");
        compared += 1;
    }
    assert!(compared > 100, "{compared}");
}

/// By how much the two points of a pair move apart along its normal.
fn rate(near: &Proximity, before: &[Pose], after: &[Pose]) -> f64 {
    let moved = near.carriers.map(|carrier| {
        carrier.map_or(0.0, |(link, point)| {
            let there = after[link] * (before[link].inverse() * point);
            near.normal.dot(&(there - point))
        })
    });
    moved[1] - moved[0]
}

#[test]
fn pairs_are_sorted_out_by_sampling_and_then_left_out() {
    let robot = ur5();
    let pairs = sampled(&robot, 2000, 1);
    assert_eq!(pairs, sampled(&robot, 2000, 1));
    let has =
        |pairs: &[[String; 2]], a: &str, b: &str| pairs.iter().any(|p| p[0] == a && p[1] == b);
    assert!(has(&pairs.never, "wrist_1_link", "ag95_left_finger"), "{pairs:?}");
    // The hand reaches the foot of the arm at some postures.
    assert!(![&pairs.never, &pairs.always].iter().any(|p| has(p, "base_link", "ag95_palm")));
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/ur5-ag95.urdf");
    let options = RobotOptions { unchecked_pairs: pairs.never, ..RobotOptions::default() };
    let spared = RobotModel::from_urdf(&file, &options).unwrap();
    let all = checker(&robot, &[]).compared().count();
    assert_eq!(checker(&spared, &[]).compared().count() + options.unchecked_pairs.len(), all);
}

/// When this fails, print the table anew with the example `pairs`.
#[test]
fn the_robot_files_hold_what_sampling_finds() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots");
    for name in ["ur5-ag95", "panda-ag95"] {
        let text = std::fs::read_to_string(folder.join(format!("{name}-sim.toml"))).unwrap();
        let table: toml::Table = text.parse().unwrap();
        let stored =
            |key: &str| -> Vec<[String; 2]> { table["collision"][key].clone().try_into().unwrap() };
        let urdf = folder.join(format!("{name}.urdf"));
        let robot = RobotModel::from_urdf(&urdf, &RobotOptions::default()).unwrap();
        let found = sampled(&robot, SAMPLES, 1);
        assert_eq!((stored("always"), stored("never")), (found.always, found.never), "{name}");
    }
}
