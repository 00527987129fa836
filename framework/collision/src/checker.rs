//! What touches what at a posture.

use crate::body::{Body, Kind, bodies, pairs};
use crate::convex::Gap;
use crate::{Convex, Margins, Placed, Room, Rules};
use nalgebra::{Isometry3, Vector3};
use seeone_core::Pose;
use seeone_core::robot::RobotModel;
use seeone_plugin::motion::Obstacle;
use seeone_plugin::{Clearance, Contact, Proximity};

/// Distances are searched for and are right to less than this, metres.
const ROUNDING_M: f64 = 1e-4;
/// What is carried may come nearer by so much, on the way, to what it is brought near to, metres:
/// the hull of a hollow object is full.
const NEARER_M: f64 = 0.01;

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
    /// the closed hand's tool frame: it keeps away from what the arm keeps away from, and from
    /// the arm.
    #[must_use]
    pub fn carrying(mut self, shape: Convex) -> Self {
        let link = self.robot.joints().len();
        let name = "held".to_owned();
        let pose = *self.robot.tool();
        self.bodies.push(Body { name, kind: Kind::Held, link, shape, pose });
        self.pairs = pairs(self.robot, &self.bodies);
        self
    }

    /// How near what is carried may come to each thing on a move whose ends are these poses of
    /// the closed hand's tool: what it touches there it is meant to touch, and what it is near to it
    /// may be near to all the way. From the rest it keeps its margin.
    pub fn room(&self, ends: [&Pose; 2]) -> Room {
        let held = || self.bodies.iter().filter(|body| body.kind == Kind::Held);
        let least = |nearer_m: f64, distance: &dyn Fn(&Placed) -> f64| {
            let at_ends = ends.iter().flat_map(|end| held().map(|body| body.shape.at(**end)));
            let nearest_m = at_ends.map(|placed| distance(&placed)).fold(f64::INFINITY, f64::min);
            match nearest_m < self.margins.carried_m {
                true => nearest_m - nearer_m,
                false => self.margins.carried_m,
            }
        };
        Room {
            tables: (self.tables.iter())
                .map(|(height, _)| least(ROUNDING_M, &|placed| placed.lowest().z - height))
                .collect(),
            standing: (self.standing.iter())
                .map(|standing| least(NEARER_M, &|placed| placed.distance(&standing.placed())))
                .collect(),
        }
    }

    /// The first pair found that is too near at `q`, if there is one.
    pub fn contact_under(&self, q: &[f64], rules: &Rules) -> Option<Contact> {
        let placed = self.placed(q);
        self.with_obstacles(&placed, rules).or_else(|| self.with_itself(&placed))
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
        for (body, placed) in self.moving(placed) {
            let room = rules.room.filter(|_| body.kind == Kind::Held);
            for (index, (height, soft)) in self.tables.iter().enumerate() {
                let (top, wanted_m) =
                    room.map_or((height - soft, 0.0), |room| (*height, room.tables[index]));
                if placed.floor() < top + wanted_m {
                    let distance_m = placed.lowest().z - top;
                    if distance_m < wanted_m {
                        return Some(contact(&body.name, "table", distance_m, wanted_m));
                    }
                }
            }
            if rules.fingers_may_touch && body.kind == Kind::Finger {
                continue;
            }
            for (index, standing) in self.standing.iter().enumerate() {
                let wanted_m = room.map_or(self.margins.clearance_m, |room| room.standing[index]);
                if let Some(lack) = placed.lack(&standing.placed(), wanted_m) {
                    return Some(contact(&body.name, &standing.name, wanted_m - lack, wanted_m));
                }
            }
        }
        None
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
