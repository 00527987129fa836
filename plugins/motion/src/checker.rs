//! What touches what at a posture.

use crate::convex::Convex;
use crate::{MotionConfig, hand::Hand};
use nalgebra::{Isometry3, Translation3};
use seeone_core::Pose;
use seeone_core::robot::{RobotModel, Solid};
use seeone_plugin::motion::Obstacle;
use std::fmt;

/// What a body belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Arm,
    Palm,
    Finger,
}

struct Body {
    name: String,
    kind: Kind,
    link: usize,
    shape: Convex,
    pose: Pose,
}

/// What is let pass at a posture.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Rules {
    /// The fingers may touch obstacles other than the table.
    pub(crate) fingers_may_touch: bool,
    /// What hangs in the hand keeps this far from every obstacle, metres from its centre.
    pub(crate) held_radius_m: Option<f64>,
}

/// Two things that touch or come too near.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Contact {
    body: String,
    other: String,
    /// By how much they are too near, metres.
    depth_m: f64,
}

impl fmt::Display for Contact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} is {:.0} mm too near to {}", self.body, 1e3 * self.depth_m, self.other)
    }
}

/// The robot with its hand in one state among obstacles.
pub(crate) struct Checker<'a> {
    robot: &'a RobotModel,
    config: &'a MotionConfig,
    bodies: Vec<Body>,
    /// Pairs of bodies that could touch: neighbouring links cannot.
    pairs: Vec<(usize, usize)>,
    /// Height of the table and how far the robot may sink into it.
    tables: Vec<(f64, f64)>,
    ellipsoids: Vec<(&'a str, Convex, Pose)>,
    held_centre: Translation3<f64>,
}

impl<'a> Checker<'a> {
    pub(crate) fn new(
        robot: &'a RobotModel,
        config: &'a MotionConfig,
        obstacles: &'a [Obstacle],
        hand: &Hand,
    ) -> Self {
        let bodies = bodies(robot, hand.opening_m);
        let count = bodies.len();
        let all = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
        let apart = |&(a, b): &(usize, usize)| bodies[a].link.abs_diff(bodies[b].link) > 1;
        let mut checker = Self {
            pairs: all.filter(apart).collect(),
            robot,
            config,
            bodies,
            tables: Vec::new(),
            ellipsoids: Vec::new(),
            held_centre: Translation3::new(0.0, 0.0, config.held_ahead_m),
        };
        for obstacle in obstacles {
            match obstacle {
                Obstacle::Table { height_m, soft_m } => checker.tables.push((*height_m, *soft_m)),
                Obstacle::Ellipsoid { name, centre, rotation, semi_axes_m } => {
                    let pose = Isometry3::from_parts((*centre).into(), *rotation);
                    checker.ellipsoids.push((name, Convex::ellipsoid(*semi_axes_m), pose));
                }
            }
        }
        checker
    }

    /// The first contact at `q`, if there is one.
    pub(crate) fn contact(&self, q: &[f64], rules: &Rules) -> Option<Contact> {
        let links = self.robot.forward(q);
        let poses: Vec<Pose> =
            self.bodies.iter().map(|body| links[body.link] * body.pose).collect();
        self.with_obstacles(&poses, rules)
            .or_else(|| rules.held_radius_m.and_then(|radius| self.with_held(q, radius)))
            .or_else(|| self.with_itself(&poses))
    }

    /// Distance from what hangs in the hand (its centre) to the nearest obstacle, metres.
    pub(crate) fn held_clearance(&self, q: &[f64]) -> f64 {
        let (point, pose) = (Convex::ball(0.0), self.held_pose(q));
        let tables = self.tables.iter().map(|(height, _)| pose.translation.z - height);
        let ellipsoids =
            self.ellipsoids.iter().map(|(_, shape, at)| point.distance(&pose, shape, at));
        tables.chain(ellipsoids).fold(f64::INFINITY, f64::min)
    }

    fn held_pose(&self, q: &[f64]) -> Pose {
        self.robot.tool_pose(q) * self.held_centre
    }

    fn with_obstacles(&self, poses: &[Pose], rules: &Rules) -> Option<Contact> {
        let clearance = self.config.clearance_m;
        // The base stands where it stands.
        let moving = self.bodies.iter().zip(poses).filter(|(body, _)| body.link > 0);
        for (body, pose) in moving {
            for (height, soft) in &self.tables {
                let floor = height - soft;
                let depth_m = floor - body.shape.lowest(pose);
                if depth_m > 0.0 {
                    return Some(contact(&body.name, "the table", depth_m));
                }
            }
            if rules.fingers_may_touch && body.kind == Kind::Finger {
                continue;
            }
            for (name, shape, at) in &self.ellipsoids {
                if let Some(depth_m) = too_near((&body.shape, pose), (shape, at), clearance) {
                    return Some(contact(&body.name, &format!("the {name}"), depth_m));
                }
            }
        }
        None
    }

    fn with_held(&self, q: &[f64], radius: f64) -> Option<Contact> {
        let depth_m = radius - self.held_clearance(q);
        (depth_m > 0.0).then(|| contact("what is held", "an obstacle", depth_m))
    }

    fn with_itself(&self, poses: &[Pose]) -> Option<Contact> {
        self.pairs.iter().find_map(|&(a, b)| {
            let (one, other) = (&self.bodies[a], &self.bodies[b]);
            too_near((&one.shape, &poses[a]), (&other.shape, &poses[b]), 0.0)
                .map(|depth_m| contact(&one.name, &other.name, depth_m))
        })
    }
}

fn contact(body: &str, other: &str, depth_m: f64) -> Contact {
    Contact { body: body.to_owned(), other: other.to_owned(), depth_m }
}

/// By how much two bodies are nearer than `clearance`.
fn too_near(a: (&Convex, &Pose), b: (&Convex, &Pose), clearance: f64) -> Option<f64> {
    let apart = (a.1.translation.vector - b.1.translation.vector).norm();
    if apart > a.0.bound() + b.0.bound() + clearance {
        return None;
    }
    let depth = clearance - a.0.distance(a.1, b.0, b.1);
    (depth > 0.0).then_some(depth)
}

fn bodies(robot: &RobotModel, opening_m: f64) -> Vec<Body> {
    let body = |solid: &Solid, kind, link| Body {
        name: solid.part.clone(),
        kind,
        link,
        shape: Convex::from(&solid.shape),
        pose: solid.pose,
    };
    let last = robot.joints().len();
    let mut bodies = Vec::new();
    for (link, solids) in robot.links().iter().enumerate() {
        bodies.extend(solids.collision.iter().map(|solid| body(solid, Kind::Arm, link)));
    }
    let gripper = robot.gripper();
    bodies.extend(gripper.palm_collision().iter().map(|solid| body(solid, Kind::Palm, last)));
    let fingers = gripper.finger_collision(opening_m);
    bodies.extend(fingers.iter().map(|solid| body(solid, Kind::Finger, last)));
    bodies
}
