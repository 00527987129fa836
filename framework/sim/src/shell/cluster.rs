//! Shape matching: a set of vertices drawn towards the nearest rigid copy of its rest
//! shape (Mueller et al. 2005).

use super::rotation::nearest_rotation;
use nalgebra::{Matrix3, Point3, UnitQuaternion, Vector3};
use seeone_core::Pose;

/// How strongly a cluster returns to its shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Firmness {
    /// Rigid: the copy is met in every substep.
    Rigid,
    /// A spring of this frequency in Hz. The gain per substep is (w h)^2 / (1 + (w h)^2)
    /// with w = 2 pi f, so that the stiffness does not depend on the substep.
    Frequency(f64),
}

impl Firmness {
    fn gain(self, h: f64) -> f64 {
        match self {
            Self::Rigid => 1.0,
            Self::Frequency(hz) => {
                let squared = (std::f64::consts::TAU * hz * h).powi(2);
                squared / (1.0 + squared)
            }
        }
    }
}

#[derive(Clone, Copy, Debug)]
struct Member {
    vertex: usize,
    /// Mass in the fit, kg; a held vertex counts for far more, so that the grip leads.
    weight: f64,
    mass: f64,
    rest: Point3<f64>,
    /// `rest` from the weighted centre of the rest shape.
    arm: Vector3<f64>,
}

/// A cluster of vertices.
#[derive(Clone, Debug)]
pub struct Cluster {
    members: Vec<Member>,
    total: f64,
    /// About the centre at rest, 1/(kg m2).
    inverse_inertia: Matrix3<f64>,
    firmness: Firmness,
    rotation: UnitQuaternion<f64>,
    centre: Vector3<f64>,
}

/// Weight of a held vertex against a free one's in the cluster that a grip leads.
const HELD_WEIGHT: f64 = 1.0e5;

impl Cluster {
    /// A cluster of `vertices` with their `rest` positions and `masses` (both indexed by
    /// vertex), now turned by about `rotation` from rest. Needs three vertices that are
    /// not on a line; `None` for fewer than three.
    pub fn new(
        vertices: &[usize],
        rest: &[Point3<f64>],
        masses: &[f64],
        firmness: Firmness,
        rotation: UnitQuaternion<f64>,
    ) -> Option<Self> {
        if vertices.len() < 3 {
            return None;
        }
        let member = |v: &usize| Member {
            vertex: *v,
            weight: masses[*v],
            mass: masses[*v],
            rest: rest[*v],
            arm: Vector3::zeros(),
        };
        let members = vertices.iter().map(member).collect();
        let mut cluster = Self {
            members,
            total: 0.0,
            inverse_inertia: Matrix3::zeros(),
            firmness,
            rotation,
            centre: Vector3::zeros(),
        };
        cluster.measure();
        Some(cluster)
    }

    /// How strongly it returns to its shape.
    pub fn firmness(&self) -> Firmness {
        self.firmness
    }

    /// Its vertices.
    pub fn vertices(&self) -> impl Iterator<Item = usize> {
        self.members.iter().map(|m| m.vertex)
    }

    /// Lets the vertices that `held` names lead the fit, and no others. Whether there are
    /// any.
    pub fn lead(&mut self, held: impl Fn(usize) -> bool) -> bool {
        let mut led = false;
        for m in &mut self.members {
            let leads = held(m.vertex);
            m.weight = if leads { m.mass * HELD_WEIGHT } else { m.mass };
            led |= leads;
        }
        self.measure();
        led
    }

    fn measure(&mut self) {
        self.total = self.members.iter().map(|m| m.weight).sum();
        let sum: Vector3<f64> = self.members.iter().map(|m| m.rest.coords * m.weight).sum();
        let centre = Point3::from(sum / self.total);
        let mut inertia = Matrix3::zeros();
        for m in &mut self.members {
            m.arm = m.rest - centre;
            let square = Matrix3::identity() * m.arm.norm_squared() - m.arm * m.arm.transpose();
            inertia += square * m.weight;
        }
        self.inverse_inertia = inertia.try_inverse().unwrap_or_default();
    }

    /// The rigid copy as last solved: centred rest shape -> world.
    pub fn frame(&self) -> Pose {
        Pose::from_parts(self.centre.into(), self.rotation)
    }

    /// How far the point `at` of the cluster, moving as a rigid body where it was last
    /// solved, yields to an impulse, 1/kg.
    pub fn yielding(&self, at: &Point3<f64>) -> Matrix3<f64> {
        let arm = (at.coords - self.centre).cross_matrix();
        Matrix3::identity() / self.total - arm * self.turned_inverse_inertia() * arm
    }

    /// Moves the cluster as a rigid body by `impulse` at the point `at`, kg m.
    pub fn push(&self, position: &mut [Point3<f64>], impulse: &Vector3<f64>, at: &Point3<f64>) {
        let shift = impulse / self.total;
        let arm = at.coords - self.centre;
        let turn = self.turned_inverse_inertia() * arm.cross(impulse);
        for m in &self.members {
            let p = &mut position[m.vertex];
            *p += shift + turn.cross(&(p.coords - self.centre));
        }
    }

    fn turned_inverse_inertia(&self) -> Matrix3<f64> {
        let turn = self.rotation.to_rotation_matrix();
        turn.matrix() * self.inverse_inertia * turn.matrix().transpose()
    }

    /// The nearest rigid copy: its rotation and its centre.
    fn fit(&self, position: &[Point3<f64>]) -> (UnitQuaternion<f64>, Vector3<f64>) {
        let sum: Vector3<f64> =
            self.members.iter().map(|m| position[m.vertex].coords * m.weight).sum();
        let mut moment = Matrix3::zeros();
        for m in &self.members {
            moment += position[m.vertex].coords * (m.arm * m.weight).transpose();
        }
        (nearest_rotation(&moment, self.rotation), sum / self.total)
    }

    /// Draws the vertices towards the copy in a substep of `h` seconds. A vertex of
    /// `inverse_mass` zero stays where it is.
    pub fn solve(&mut self, position: &mut [Point3<f64>], inverse_mass: &[f64], h: f64) {
        let (rotation, centre) = self.fit(position);
        (self.rotation, self.centre) = (rotation, centre);
        let gain = self.firmness.gain(h);
        let turn = rotation.to_rotation_matrix();
        for m in self.members.iter().filter(|m| inverse_mass[m.vertex] > 0.0) {
            let p = &mut position[m.vertex];
            *p += (turn * m.arm + centre - p.coords) * gain;
        }
    }

    /// Elastic energy of a springy cluster, J; none for a rigid one.
    pub fn energy(&self, position: &[Point3<f64>]) -> f64 {
        let Firmness::Frequency(hz) = self.firmness else { return 0.0 };
        let (rotation, centre) = self.fit(position);
        let squared = |m: &Member| {
            m.mass * (rotation * m.arm + centre - position[m.vertex].coords).norm_squared()
        };
        let sum: f64 = self.members.iter().map(squared).sum();
        (std::f64::consts::TAU * hz).powi(2) * sum / 2.0
    }

    /// Root mean square distance of the vertices from the nearest rigid copy, metres.
    pub fn residual(&self, position: &[Point3<f64>]) -> f64 {
        let (rotation, centre) = self.fit(position);
        let squared =
            |m: &Member| (rotation * m.arm + centre - position[m.vertex].coords).norm_squared();
        let sum: f64 = self.members.iter().map(squared).sum();
        (sum / self.members.len() as f64).sqrt()
    }
}
