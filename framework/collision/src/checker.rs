//! What touches what at a posture.

use crate::body::{Body, Kind, bodies, pairs};
use crate::convex::Gap;
use crate::{Convex, Margins, Placed, Rules};
use nalgebra::{Isometry3, Translation3, Vector3};
use seeone_core::Pose;
use seeone_core::robot::RobotModel;
use seeone_plugin::motion::Obstacle;
use seeone_plugin::{Clearance, Contact, Proximity};

/// A body that stands in `world`.
struct Standing {
    name: String,
    shape: Convex,
    pose: Pose,
}

/// The robot with its hand in one state among obstacles.
pub struct Checker<'a> {
    robot: &'a RobotModel,
    margins: Margins,
    bodies: Vec<Body>,
    /// Pairs of the robot's own bodies that could touch.
    pairs: Vec<(usize, usize)>,
    /// Height of the table and how far the robot may sink into it.
    tables: Vec<(f64, f64)>,
    standing: Vec<Standing>,
    held_centre: Translation3<f64>,
}

impl<'a> Checker<'a> {
    /// The robot among `obstacles` with its pads `opening_m` apart.
    pub fn new(
        robot: &'a RobotModel,
        margins: Margins,
        obstacles: &[Obstacle],
        opening_m: f64,
    ) -> Self {
        let bodies = bodies(robot, opening_m);
        let mut checker = Self {
            pairs: pairs(robot, &bodies),
            robot,
            margins,
            bodies,
            tables: Vec::new(),
            standing: Vec::new(),
            held_centre: Translation3::new(0.0, 0.0, margins.held_ahead_m),
        };
        for obstacle in obstacles {
            match obstacle {
                Obstacle::Table { height_m, soft_m } => checker.tables.push((*height_m, *soft_m)),
                Obstacle::Ellipsoid { name, centre, rotation, semi_axes_m } => {
                    let pose = Isometry3::from_parts((*centre).into(), *rotation);
                    checker.stand(name, Convex::ellipsoid(*semi_axes_m), pose);
                }
                Obstacle::Solid(solid) => {
                    checker.stand(&solid.part, Convex::from(&solid.shape), solid.pose);
                }
            }
        }
        checker
    }

    /// The same with a body in the hand, e.g. the hull of the cloud that was seen of it, in
    /// the tool frame: it keeps away from what the arm keeps away from, and from the arm.
    #[must_use]
    pub fn carrying(mut self, shape: Convex) -> Self {
        let link = self.robot.joints().len();
        let name = "held".to_owned();
        let pose = *self.robot.tool();
        self.bodies.push(Body { name, kind: Kind::Held, link, shape, pose });
        self.pairs = pairs(self.robot, &self.bodies);
        self
    }

    /// The first pair found that is too near at `q`, if there is one.
    pub fn contact_under(&self, q: &[f64], rules: &Rules) -> Option<Contact> {
        let placed = self.placed(q);
        self.with_obstacles(&placed, rules)
            .or_else(|| rules.held_radius_m.and_then(|radius| self.with_held(q, radius)))
            .or_else(|| self.with_itself(&placed))
    }

    /// Distance from what hangs in the hand (its centre) to the nearest obstacle, metres.
    pub fn held_clearance(&self, q: &[f64]) -> f64 {
        let pose = self.robot.tool_pose(q) * self.held_centre;
        let point = Convex::ball(0.0);
        let centre = point.at(pose);
        let tables = self.tables.iter().map(|(height, _)| pose.translation.z - height);
        let standing = self.standing.iter().map(|standing| centre.distance(&standing.placed()));
        tables.chain(standing).fold(f64::INFINITY, f64::min)
    }

    /// Names of the bodies that it compares at all, each pair once.
    pub fn compared(&self) -> impl Iterator<Item = [&str; 2]> {
        self.pairs
            .iter()
            .map(|&(a, b)| [self.bodies[a].name.as_str(), self.bodies[b].name.as_str()])
    }

    fn stand(&mut self, name: &str, shape: Convex, pose: Pose) {
        self.standing.push(Standing { name: name.to_owned(), shape, pose });
    }

    /// All bodies in `world`.
    fn placed(&self, q: &[f64]) -> Vec<Placed<'_>> {
        let links = self.robot.forward(q);
        self.bodies.iter().map(|body| body.placed(&links)).collect()
    }

    /// The bodies that could touch obstacles: the base stands where it stands.
    fn moving<'b>(
        &'b self,
        placed: &'b [Placed<'b>],
    ) -> impl Iterator<Item = (&'b Body, &'b Placed<'b>)> {
        self.bodies.iter().zip(placed).filter(|(body, _)| body.link > 0)
    }

    fn with_obstacles(&self, placed: &[Placed], rules: &Rules) -> Option<Contact> {
        let wanted_m = self.margins.clearance_m;
        for (body, placed) in self.moving(placed) {
            for floor in self.tables.iter().map(|(height, soft)| height - soft) {
                if placed.floor() < floor {
                    let distance_m = placed.lowest().z - floor;
                    if distance_m < 0.0 {
                        return Some(contact(&body.name, "table", distance_m, 0.0));
                    }
                }
            }
            if rules.fingers_may_touch && body.kind == Kind::Finger {
                continue;
            }
            for standing in &self.standing {
                if let Some(lack) = placed.lack(&standing.placed(), wanted_m) {
                    return Some(contact(&body.name, &standing.name, wanted_m - lack, wanted_m));
                }
            }
        }
        None
    }

    fn with_held(&self, q: &[f64], radius: f64) -> Option<Contact> {
        let distance_m = self.held_clearance(q);
        (distance_m < radius).then(|| contact("held", "obstacle", distance_m, radius))
    }

    fn with_itself(&self, placed: &[Placed]) -> Option<Contact> {
        self.pairs.iter().find_map(|&(a, b)| {
            let lack = placed[a].lack(&placed[b], 0.0)?;
            Some(contact(&self.bodies[a].name, &self.bodies[b].name, -lack, 0.0))
        })
    }
}

impl Standing {
    fn placed(&self) -> Placed<'_> {
        self.shape.at(self.pose)
    }
}

impl Clearance for Checker<'_> {
    fn contact(&self, q: &[f64]) -> Option<Contact> {
        self.contact_under(q, &Rules::default())
    }

    fn proximities(&self, q: &[f64], within_m: f64, found: &mut Vec<Proximity>) {
        found.clear();
        let placed = self.placed(q);
        let wanted_m = self.margins.clearance_m;
        let carried = |body: &Body, gap: &Gap, end: usize| Some((body.link, gap.points[end]));
        for (body, placed) in self.moving(&placed) {
            for (height, soft) in &self.tables {
                let point = placed.lowest();
                let margin_m = point.z - (height - soft);
                let carriers = [Some((body.link, point)), None];
                found.push(Proximity { margin_m, normal: -Vector3::z_axis(), carriers });
            }
            for standing in &self.standing {
                let Some(gap) = placed.gap(&standing.placed(), wanted_m + within_m) else {
                    continue;
                };
                let margin_m = gap.distance_m - wanted_m;
                let carriers = [carried(body, &gap, 0), None];
                found.push(Proximity { margin_m, normal: gap.normal, carriers });
            }
        }
        for &(a, b) in &self.pairs {
            let Some(gap) = placed[a].gap(&placed[b], within_m) else { continue };
            let carriers = [carried(&self.bodies[a], &gap, 0), carried(&self.bodies[b], &gap, 1)];
            found.push(Proximity { margin_m: gap.distance_m, normal: gap.normal, carriers });
        }
        found.retain(|near| near.margin_m < within_m);
        found.sort_by(|a, b| a.margin_m.total_cmp(&b.margin_m));
    }
}

fn contact(body: &str, other: &str, distance_m: f64, wanted_m: f64) -> Contact {
    Contact { bodies: [body.to_owned(), other.to_owned()], distance_m, wanted_m }
}
