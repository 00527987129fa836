//! The same scenes in an independent solver, the soft bodies of rapier: springs, hinges and
//! shape matching solved by impulses in single precision.

use super::check::Check;
use super::common::{a_cap, advance};
use super::plate::{LIMP, Plate};
use nalgebra::{Point3, Vector3};
use rapier3d::dynamics::SpringCoefficients;
use rapier3d::prelude as rapier;
use seeone_core::Pose;
use seeone_core::random::generator;
use seeone_sim::drop::Drop;
use seeone_sim::rigid_fit::rigid_fit;
use seeone_sim::{Object, Region, Settings, Surroundings};

/// Steps a second for hanging cloth.
const RATE_HZ: f32 = 480.0;
/// Below half of the shortest edge, or contact would push neighbours apart, metres.
const PARTICLE_RADIUS_M: f32 = 1.0e-3;

/// A soft body in a world of the reference.
struct Reference {
    world: rapier::PhysicsWorld,
    body: rapier::SoftBodyHandle,
}

impl Reference {
    /// A world with nothing but `body` under gravity.
    fn new(body: rapier::SoftBodyBuilder) -> Self {
        let mut world = rapier::PhysicsWorld::new();
        world.gravity = rapier::Vector::new(0.0, 0.0, -9.81);
        world.integration_parameters.dt = 1.0 / RATE_HZ;
        let body = world.soft_bodies.insert(body, &mut world.bodies, &mut world.colliders);
        Self { world, body }
    }

    fn advance(&mut self, seconds: f32) {
        (0..(seconds / self.world.integration_parameters.dt).round() as usize)
            .for_each(|_| self.world.step());
    }

    fn soft(&mut self) -> &mut rapier::SoftBody {
        self.world.soft_bodies.get_mut(self.body).unwrap()
    }

    fn vertices(&mut self) -> Vec<Point3<f64>> {
        self.soft().particle_positions().map(|p| Point3::new(p.x, p.y, p.z).cast()).collect()
    }
}

fn vector(p: &Point3<f64>) -> rapier::Vector {
    let p = p.cast::<f32>();
    rapier::Vector::new(p.x, p.y, p.z)
}

/// A soft body of the object's rest shape at `placed` and its masses.
fn body_of(object: &Object, placed: &Pose) -> rapier::SoftBodyBuilder {
    let vertices = object.mesh().vertices().iter().map(|v| vector(&(placed * v))).collect();
    let masses = object.vertex_masses().iter().map(|m| *m as f32).collect();
    rapier::SoftBodyBuilder::trimesh(vertices, object.mesh().triangles().to_vec())
        .unwrap()
        .masses(masses)
        .particle_radius(PARTICLE_RADIUS_M)
        .can_sleep(false)
}

/// A limp sheet of 0.2 by 0.2 m held by its four corners, which are drawn together to 85 % of
/// their distances: mean vertical distance between the two solvers once it hangs still.
pub fn hammocks() -> Vec<Check> {
    let quantity = "sheet hung by its four corners: mean height off that in rapier's soft body";
    vec![Check::at_most(quantity, "the same shape", "m", hammock(), 0.010)]
}

fn hammock() -> f64 {
    let plate = Plate { edge_m: 0.02, strips: 12, across: 10, material: LIMP };
    let object = plate.object();
    let (near, far) = (plate.vertices_of(0), plate.vertices_of(plate.strips));
    let corners = [near.start, near.end - 1, far.start, far.end - 1];
    // Drawn together evenly and dented down a little in the middle.
    let middle = plate.length_m() / 2.0;
    let drawn = |p: &Point3<f64>| {
        let (x, y) = ((p.x - middle) / 0.1, p.y / 0.1);
        Point3::new(p.x * 0.85, p.y * 0.85, -0.01 * (1.0 - x * x) * (1.0 - y * y))
    };
    let start: Vec<_> = object.mesh().vertices().iter().map(drawn).collect();

    let mut own = plate.world(40, 5.0);
    own.set_vertices(&start).unwrap();
    own.pin(&corners).unwrap();
    advance(&mut own, 4.0);

    let material = rapier::SoftBodyMaterial {
        edge_softness: SpringCoefficients::new(RATE_HZ, 1.0),
        bend_softness: SpringCoefficients::new(0.1, 1.0),
        ..Default::default()
    };
    let body = body_of(&object, &Pose::identity())
        .shape_matching(false)
        .no_surface_collider()
        .pinned_particles(corners.map(|v| v as u32))
        .material(material)
        .linear_damping(5.0);
    let mut reference = Reference::new(body);
    for (i, p) in start.iter().enumerate() {
        reference.soft().set_particle_position(i, vector(p));
    }
    reference.advance(4.0);

    let theirs = reference.vertices();
    let apart: f64 = own.vertices().iter().zip(&theirs).map(|(a, b)| (a.z - b.z).abs()).sum();
    apart / theirs.len() as f64
}

/// Which solver a cap is dropped in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solver {
    /// The world's own, with so many substeps a frame.
    Own(usize),
    /// The reference with a stiff cluster for the visor; its one shape-matching stiffness is
    /// then too much for the crown, which has none.
    StiffVisor,
    /// The reference with a weak cluster for the whole cap and none for the visor.
    WeakWhole,
}

/// What became of a cap that was dropped and had 3 s to come to rest.
#[derive(Clone, Copy, Debug)]
pub struct Dropped {
    /// Root mean square distance of the vertices from the nearest rigid copy of the rest
    /// shape, metres.
    pub shape_loss_m: f64,
    /// The same over the visor by itself.
    pub visor_loss_m: f64,
    /// Root mean square speed, m/s.
    pub speed_m_s: f64,
}

/// Drops a cap of 489 vertices from 0.10 to 0.15 m in the orientation that `seed` draws.
pub fn dropped(solver: Solver, seed: u64) -> Dropped {
    let cap = a_cap();
    let drop = Drop {
        spin_rad_s: Vector3::zeros(),
        ..Drop::draw([0.0, 0.0], &mut generator(seed, "drop"))
    };
    let (now, speeds) = match solver {
        Solver::Own(substeps) => {
            let surroundings = Surroundings { table: true, ..Default::default() };
            let settings = Settings { substeps, ..Settings::default() };
            let mut world = drop.begin(&cap, surroundings, settings);
            advance(&mut world, 3.0);
            (
                world.vertices().to_vec(),
                world.velocities().iter().map(|v| v.norm_squared()).sum::<f64>(),
            )
        }
        Solver::StiffVisor | Solver::WeakWhole => {
            let mut reference =
                Reference::cap(&cap, &drop.pose(&cap), solver == Solver::StiffVisor);
            reference.advance(3.0);
            let speeds =
                reference.soft().particle_velocities().map(|v| f64::from(v.length_squared()));
            let speeds = speeds.sum();
            (reference.vertices(), speeds)
        }
    };
    let rest = cap.mesh().vertices();
    let loss = |of: &[usize]| {
        let pick = |all: &[Point3<f64>]| of.iter().map(|v| all[*v]).collect::<Vec<_>>();
        let (from, to) = (pick(rest), pick(&now));
        let fit = rigid_fit(&from, &to);
        let sum: f64 = from.iter().zip(&to).map(|(a, b)| (fit * a - b).norm_squared()).sum();
        (sum / of.len() as f64).sqrt()
    };
    Dropped {
        shape_loss_m: loss(&(0..rest.len()).collect::<Vec<_>>()),
        visor_loss_m: loss(&cap.vertices_of(Region::Brim)),
        speed_m_s: (speeds / rest.len() as f64).sqrt(),
    }
}

impl Reference {
    /// A cap over a table, at 240 steps a second.
    fn cap(cap: &Object, placed: &Pose, stiff_visor: bool) -> Self {
        let firm = |hz| SpringCoefficients::new(hz, 1.0);
        let material = rapier::SoftBodyMaterial {
            edge_softness: firm(240.0),
            bend_softness: firm(if stiff_visor { 60.0 } else { 8.0 }),
            shape_matching_softness: firm(if stiff_visor { 200.0 } else { 5.0 }),
            ..Default::default()
        };
        let body = body_of(cap, placed)
            .shape_matching(!stiff_visor)
            .self_contacts(true)
            .oriented(false)
            .surface_collider(rapier::ColliderBuilder::ball(0.01).friction(0.5))
            .material(material)
            .linear_damping(2.0);
        let mut reference = Self::new(body);
        let Self { world, body } = &mut reference;
        world.integration_parameters.dt = 1.0 / 240.0;
        let table = rapier::ColliderBuilder::cuboid(2.0, 2.0, 0.5);
        let table = table.translation(rapier::Vector::new(0.0, 0.0, -0.5)).friction(0.5);
        world.colliders.insert(table);
        if stiff_visor {
            let visor: Vec<u32> = cap.vertices_of(Region::Brim).iter().map(|v| *v as u32).collect();
            let cluster = world.add_soft_body_cluster(*body, &visor).unwrap();
            let body = world.soft_bodies.get_mut(*body).unwrap();
            body.enable_cluster_shape_matching(cluster, true);
        }
        reference
    }
}
