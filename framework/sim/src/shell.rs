//! A thin shell under extended position-based dynamics (XPBD): in-plane springs, hinges,
//! and shape-matching clusters for what springs and hinges cannot hold stiff.
//!
//! One substep of `h` seconds predicts, then solves the hem's band, the springs backward,
//! the hinges, the clusters, the springs forward and the band again; whoever owns the
//! shell then adds contacts and grips, and ends the substep, which makes velocities from
//! the positions. One thread, fixed order: the same start gives the same bytes.

mod band;
pub mod bend;
pub mod cluster;
mod colouring;
mod lanes;
mod motion;
mod rotation;
mod stretch;
pub mod topology;

pub use motion::Momentum;

use crate::object::{Object, Region};
use band::Band;
use bend::Bend;
use cluster::{Cluster, Firmness};
use nalgebra::{Matrix3, Point3, Vector3};
use seeone_core::Pose;
use stretch::Stretch;

/// Speed that no vertex exceeds, m/s: a drop from 0.15 m reaches 1.7.
const SPEED_LIMIT_M_S: f64 = 5.0;
/// Length over which a stiffened region bends, metres.
const BENDING_LENGTH_M: f64 = 0.07;

/// A deformable shell: positions, velocities and what holds it together.
#[derive(Clone, Debug)]
pub struct Shell {
    pub(crate) position: Vec<Point3<f64>>,
    /// Positions at the start of the substep.
    pub(crate) previous: Vec<Point3<f64>>,
    pub(crate) velocity: Vec<Vector3<f64>>,
    pub(crate) mass: Vec<f64>,
    /// 1/kg; zero for a vertex whose position something else decides.
    pub(crate) inverse_mass: Vec<f64>,
    bending_damping_s: f64,
    stretch: Stretch,
    band: Option<Band>,
    bend: Bend,
    /// The whole object first, then its stiffened regions.
    clusters: Vec<Cluster>,
    /// For each vertex the cluster that moves as a free rigid body with it.
    rigid_part: Vec<Option<usize>>,
}

impl Shell {
    /// The object at rest at `placed` (object frame -> world).
    pub fn new(object: &Object, placed: &Pose) -> Self {
        let mesh = object.mesh();
        let position: Vec<_> = mesh.vertices().iter().map(|v| placed * v).collect();
        let mass = object.vertex_masses();
        let edges = topology::edges(mesh.triangles());
        let everything: Vec<usize> = (0..mass.len()).collect();
        let cluster = |vertices: &[usize], firmness| {
            Cluster::new(vertices, mesh.vertices(), &mass, firmness, placed.rotation)
        };
        let whole = Firmness::Frequency(object.softness_hz());
        let stiffened = [Region::Front, Region::Brim]
            .map(|region| (object.vertices_of(region), firmness(object, region)));
        let stiffened = stiffened.iter().map(|(part, firm)| cluster(part, *firm));
        let clusters = [cluster(&everything, whole)].into_iter().chain(stiffened).flatten();
        let mut shell = Self {
            previous: position.clone(),
            velocity: vec![Vector3::zeros(); position.len()],
            inverse_mass: mass.iter().map(|m| 1.0 / m).collect(),
            bending_damping_s: bend::BENDING_DAMPING_S,
            stretch: Stretch::new(mesh, &edges),
            band: Band::new(object, &edges),
            bend: Bend::new(object, &edges),
            clusters: clusters.collect(),
            rigid_part: vec![None; mass.len()],
            position,
            mass,
        };
        shell.pin(&[]);
        shell
    }

    /// Damps bending and moves every free vertex by its velocity under `gravity` (m/s2).
    /// Velocity decays at `damping` (1/s).
    pub fn predict(&mut self, h: f64, gravity: &Vector3<f64>, damping: f64) {
        let (v, w) = (&mut self.velocity, &self.inverse_mass);
        self.bend.damp(v, w, h, self.bending_damping_s);
        let keep = 1.0 / (1.0 + damping * h);
        self.previous.copy_from_slice(&self.position);
        for ((p, v), w) in self.position.iter_mut().zip(&mut self.velocity).zip(&self.inverse_mass)
        {
            if *w > 0.0 {
                *v = (*v + gravity * h) * keep;
                *p += *v * h;
            }
        }
    }

    /// Stretching, bending and clusters.
    pub fn solve(&mut self, h: f64) {
        let (x, w) = (&mut self.position, &self.inverse_mass);
        self.band.iter_mut().for_each(|b| b.solve(x, w, h));
        self.stretch.solve_backward(x, w, h);
        self.bend.solve(x, &self.previous, w, h);
        self.clusters.iter_mut().for_each(|c| c.solve(x, w, h));
        self.stretch.solve_forward(x, w, h);
        self.band.iter_mut().for_each(|b| b.solve(x, w, h));
    }

    /// Makes velocities from the positions at both ends of the substep.
    pub fn finish(&mut self, h: f64) {
        for ((v, p), q) in self.velocity.iter_mut().zip(&self.position).zip(&self.previous) {
            *v = (p - q) / h;
            let speed = v.norm();
            if speed > SPEED_LIMIT_M_S {
                *v *= SPEED_LIMIT_M_S / speed;
            }
        }
    }

    /// The rigid motion of the whole shell as last solved: rest shape -> world, but for a
    /// fixed shift.
    pub fn frame(&self) -> Pose {
        self.clusters.first().map_or_else(Pose::identity, Cluster::frame)
    }

    /// Puts every vertex at `position`, at rest.
    pub fn rest_at(&mut self, position: &[Point3<f64>]) {
        self.position.copy_from_slice(position);
        self.velocity.fill(Vector3::zeros());
        self.bend.forget();
    }

    /// Whether every position and velocity is finite.
    pub fn is_finite(&self) -> bool {
        let finite = |v: &Vector3<f64>| v.iter().all(|c| c.is_finite());
        self.position.iter().all(|p| finite(&p.coords)) && self.velocity.iter().all(finite)
    }

    /// Takes `vertices` out of the dynamics: their positions are decided elsewhere, and
    /// they lead the rigid cluster they belong to. An empty list frees everything.
    pub fn pin(&mut self, vertices: &[usize]) {
        for (w, m) in self.inverse_mass.iter_mut().zip(&self.mass) {
            *w = 1.0 / m;
        }
        vertices.iter().for_each(|v| self.inverse_mass[*v] = 0.0);
        // Only rigid parts follow the grip: were the weak cluster of the whole object led
        // too, its far side would be flung.
        self.rigid_part.fill(None);
        for (index, c) in self.clusters.iter_mut().enumerate() {
            if c.firmness() == Firmness::Rigid && !c.lead(|v| vertices.contains(&v)) {
                c.vertices().for_each(|v| self.rigid_part[v] = Some(index));
            }
        }
    }

    /// How far `vertex` yields to an impulse when its rigid part moves with it, 1/kg;
    /// `None` for a vertex that is soft, or whose part is held.
    #[inline]
    pub fn yielding(&self, vertex: usize) -> Option<Matrix3<f64>> {
        self.rigid_part[vertex].map(|c| self.clusters[c].yielding(&self.position[vertex]))
    }

    /// Moves the rigid part of `vertex` as `impulse` there would within this substep, kg m.
    pub fn push_part(&mut self, vertex: usize, impulse: &Vector3<f64>) {
        if let Some(part) = self.rigid_part[vertex] {
            let at = self.position[vertex];
            self.clusters[part].push(&mut self.position, impulse, &at);
        }
    }

    /// Whether `vertex` belongs to a rigid part.
    pub fn is_rigid(&self, vertex: usize) -> bool {
        self.clusters
            .iter()
            .any(|c| c.firmness() == Firmness::Rigid && c.vertices().any(|v| v == vertex))
    }

    /// Stretching, bending and cluster energy, J.
    pub fn elastic_energy(&self) -> f64 {
        let x = &self.position;
        let clusters: f64 = self.clusters.iter().map(|c| c.energy(x)).sum();
        let band = self.band.as_ref().map_or(0.0, |b| b.energy(x));
        self.stretch.energy(x) + band + self.bend.energy(x) + clusters
    }

    /// Mean and largest absolute strain of the edges.
    pub fn strain(&self) -> (f64, f64) {
        self.stretch.strain(&self.position)
    }

    /// The absolute strain that `share` (0 to 1) of the edges do not exceed.
    pub fn strain_quantile(&self, share: f64) -> f64 {
        self.stretch.strain_quantile(&self.position, share)
    }

    /// Root mean square angle between the hinges inside `region` and their rest angles,
    /// radians; 0 for a region without a hinge.
    pub fn hinge_error(&self, region: Region) -> f64 {
        self.bend.error(&self.position, region)
    }

    /// Root mean square distance of the vertices from the nearest rigid copy of the rest
    /// shape, metres.
    pub fn shape_residual(&self) -> f64 {
        self.clusters.first().map_or(0.0, |whole| whole.residual(&self.position))
    }
}

/// A stiffened region is rigid, or springs back at the first frequency of a cantilever of
/// its material: f = 3.516 / (2 pi L^2) sqrt(B / rho).
fn firmness(object: &Object, region: Region) -> Firmness {
    let material = &object.materials()[region.index()];
    if material.is_rigid() {
        return Firmness::Rigid;
    }
    let wave = (material.bending_n_m / material.density_kg_m2).sqrt();
    Firmness::Frequency(3.516 * wave / (std::f64::consts::TAU * BENDING_LENGTH_M.powi(2)))
}

#[cfg(test)]
mod tests;
