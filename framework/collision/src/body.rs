//! The robot as convex bodies.

use crate::{Convex, Placed};
use seeone_core::Pose;
use seeone_core::robot::{RobotModel, Solid};

/// What a body belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Arm,
    Palm,
    Finger,
    Held,
}

/// A body that the arm carries.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    /// The URDF link, or what is held.
    pub(crate) name: String,
    pub(crate) kind: Kind,
    /// Index of the arm's link that carries it.
    pub(crate) link: usize,
    pub(crate) shape: Convex,
    /// In that link.
    pub(crate) pose: Pose,
}

impl Body {
    /// The body where the arm's links, posed in `world`, carry it.
    pub(crate) fn placed(&self, links: &[Pose]) -> Placed<'_> {
        self.shape.at(links[self.link] * self.pose)
    }
}

/// The bodies of a robot with its pads `opening_m` apart.
pub(crate) fn bodies(robot: &RobotModel, opening_m: f64) -> Vec<Body> {
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

/// Pairs of bodies that could touch: those on one link or on neighbouring ones cannot, nor
/// those that the robot's file leaves out.
pub(crate) fn pairs(robot: &RobotModel, bodies: &[Body]) -> Vec<(usize, usize)> {
    let apart = |a: &Body, b: &Body| a.link.abs_diff(b.link) > 1;
    let unchecked = |a: &Body, b: &Body| {
        robot.unchecked_pairs().iter().any(|[one, other]| {
            (one == &a.name && other == &b.name) || (one == &b.name && other == &a.name)
        })
    };
    let count = bodies.len();
    let all = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
    all.filter(|&(a, b)| apart(&bodies[a], &bodies[b]) && !unchecked(&bodies[a], &bodies[b]))
        .collect()
}
