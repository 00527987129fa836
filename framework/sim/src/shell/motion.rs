//! Energies and momenta of a shell.

use super::Shell;
use nalgebra::{Matrix3, Point3, Vector3};

/// Linear and angular momentum about the world's origin, or a change of both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Momentum {
    /// kg m/s.
    pub linear: Vector3<f64>,
    /// kg m2/s about the world's origin.
    pub angular: Vector3<f64>,
}

impl Momentum {
    /// None.
    pub fn zero() -> Self {
        Self { linear: Vector3::zeros(), angular: Vector3::zeros() }
    }

    /// Adds the linear momentum `impulse` at the point `at`.
    pub fn add(&mut self, impulse: &Vector3<f64>, at: &Point3<f64>) {
        self.linear += impulse;
        self.angular += at.coords.cross(impulse);
    }
}

impl Shell {
    /// Total mass, kg.
    pub fn total_mass(&self) -> f64 {
        self.mass.iter().sum()
    }

    /// Centre of mass in world, metres.
    pub fn centre_of_mass(&self) -> Point3<f64> {
        let sum: Vector3<f64> =
            self.position.iter().zip(&self.mass).map(|(p, m)| p.coords * *m).sum();
        Point3::from(sum / self.total_mass())
    }

    /// Momentum about the world's origin.
    pub fn momentum(&self) -> Momentum {
        let mut total = Momentum::zero();
        for ((p, v), m) in self.position.iter().zip(&self.velocity).zip(&self.mass) {
            total.add(&(v * *m), p);
        }
        total
    }

    /// Kinetic energy, J.
    pub fn kinetic_energy(&self) -> f64 {
        self.velocity.iter().zip(&self.mass).map(|(v, m)| m * v.norm_squared() / 2.0).sum()
    }

    /// Mass-weighted root mean square speed, m/s.
    pub fn rms_speed(&self) -> f64 {
        (2.0 * self.kinetic_energy() / self.total_mass()).sqrt()
    }

    /// As [`Shell::rms_speed`] with the rigid part of the motion taken out: what still
    /// deforms, m/s.
    pub fn deformation_rms_speed(&self) -> f64 {
        let Spin { centre, drift, rate, .. } = self.spin();
        let squared = |((p, v), m): ((&Point3<f64>, &Vector3<f64>), &f64)| {
            m * (v - drift - rate.cross(&(p - centre))).norm_squared()
        };
        let sum: f64 = self.position.iter().zip(&self.velocity).zip(&self.mass).map(squared).sum();
        (sum / self.total_mass()).sqrt()
    }

    /// Takes up to `torque_impulse` (N m s) against the spin, never beyond a standstill.
    pub fn brake_spin(&mut self, torque_impulse: f64) {
        let Spin { centre, rate, inverse_inertia, .. } = self.spin();
        let Some(axis) = rate.try_normalize(0.0) else { return };
        let slower = axis.dot(&(inverse_inertia * axis)) * torque_impulse;
        let change = axis * -slower.min(rate.norm());
        for (v, p) in self.velocity.iter_mut().zip(&self.position) {
            *v += change.cross(&(p - centre));
        }
    }

    fn spin(&self) -> Spin {
        let (centre, mass) = (self.centre_of_mass(), self.total_mass());
        let momentum = self.momentum();
        let about_centre = momentum.angular - centre.coords.cross(&momentum.linear);
        let mut inertia = Matrix3::zeros();
        for (p, m) in self.position.iter().zip(&self.mass) {
            let r = p - centre;
            inertia += (Matrix3::identity() * r.norm_squared() - r * r.transpose()) * *m;
        }
        let inverse_inertia = inertia.try_inverse().unwrap_or_default();
        let rate = inverse_inertia * about_centre;
        Spin { centre, drift: momentum.linear / mass, rate, inverse_inertia }
    }
}

/// The rigid part of a motion.
struct Spin {
    centre: Point3<f64>,
    /// Velocity of the centre of mass, m/s.
    drift: Vector3<f64>,
    /// Angular velocity, rad/s.
    rate: Vector3<f64>,
    /// About the centre of mass, 1/(kg m2).
    inverse_inertia: Matrix3<f64>,
}
