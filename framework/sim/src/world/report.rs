//! What can be asked of a world.

use super::{FRAME_S, World, WorldFault};
use crate::contact::Body;
use crate::hand::Hand;
use crate::object::Region;
use crate::surroundings::Surroundings;
use nalgebra::{Point3, Vector3};
use seeone_core::TriangleMesh;

impl World {
    /// Positions of the object's vertices in world, metres.
    pub fn vertices(&self) -> &[Point3<f64>] {
        &self.shell.position
    }

    /// Velocities of the object's vertices in world, m/s.
    pub fn velocities(&self) -> &[Vector3<f64>] {
        &self.shell.velocity
    }

    /// The object as it is now, in world.
    pub fn mesh(&self) -> TriangleMesh {
        self.rest
            .with_vertices(self.shell.position.clone())
            .expect("as many vertices as at rest, all finite: a frame that is not is undone")
    }

    /// The hand, if there is one.
    pub fn hand(&self) -> Option<&Hand> {
        self.fingers.as_ref().map(|f| &f.now)
    }

    /// The rigid surroundings.
    pub fn surroundings(&self) -> &Surroundings {
        &self.surroundings
    }

    /// Gravity in world, m/s2.
    pub fn gravity(&self) -> Vector3<f64> {
        self.settings.gravity
    }

    /// Seconds since the start.
    pub fn time(&self) -> f64 {
        self.frames as f64 * FRAME_S
    }

    /// Why it stopped, if it did.
    pub fn fault(&self) -> Option<WorldFault> {
        self.fault
    }

    /// Mass-weighted root mean square speed, m/s.
    pub fn rms_speed(&self) -> f64 {
        self.shell.rms_speed()
    }

    /// The same with rigid motion taken out, m/s.
    pub fn deformation_rms_speed(&self) -> f64 {
        self.shell.deformation_rms_speed()
    }

    /// Kinetic energy, J.
    pub fn kinetic_energy(&self) -> f64 {
        self.shell.kinetic_energy()
    }

    /// Elastic energy, J.
    pub fn elastic_energy(&self) -> f64 {
        self.shell.elastic_energy()
    }

    /// Centre of mass in world, metres.
    pub fn centre_of_mass(&self) -> Point3<f64> {
        self.shell.centre_of_mass()
    }

    /// Mass of the object, kg.
    pub fn mass(&self) -> f64 {
        self.shell.total_mass()
    }

    /// Mean and largest absolute strain of the edges.
    pub fn strain(&self) -> (f64, f64) {
        self.shell.strain()
    }

    /// The absolute strain that `share` (0 to 1) of the edges do not exceed.
    pub fn strain_quantile(&self, share: f64) -> f64 {
        self.shell.strain_quantile(share)
    }

    /// Root mean square angle between the hinges of `region` and their rest angles,
    /// radians; 0 for a region without a hinge.
    pub fn hinge_error(&self, region: Region) -> f64 {
        self.shell.hinge_error(region)
    }

    /// How many times an edge of the object pierces a triangle that it does not touch.
    pub fn crossings(&self) -> usize {
        self.self_contact.crossings(&self.shell.position)
    }

    /// Root mean square distance from the nearest rigid copy of the rest shape, metres.
    pub fn shape_residual(&self) -> f64 {
        self.shell.shape_residual()
    }

    /// Smallest distance of the object's surface from the head, its ears and neck, metres,
    /// negative inside; `None` without a head.
    pub fn min_signed_distance_to_head(&self) -> Option<f64> {
        self.surroundings.head.map(|head| self.clearance(&head.bodies(0.0)))
    }

    /// Smallest distance of the object's surface from any hook's peg, metres, negative
    /// inside; `None` without a hook.
    pub fn min_signed_distance_to_peg(&self) -> Option<f64> {
        let pegs = self.surroundings.hooks.iter().map(|hook| self.clearance(&hook.peg(0.0)));
        pegs.min_by(f64::total_cmp)
    }

    /// Smallest distance of any sample of the object from any of `bodies`, metres.
    fn clearance(&self, bodies: &[Body]) -> f64 {
        let samples = self.pads.samples().iter().map(|s| s.at(&self.shell.position));
        let nearest = |p| bodies.iter().map(|b| b.distance(&p)).fold(f64::INFINITY, f64::min);
        samples.map(nearest).fold(f64::INFINITY, f64::min)
    }
}
