//! Putting the object, or gravity, elsewhere.

use super::{PlacementFault, World};
use nalgebra::{Point3, Vector3};

impl World {
    /// Changes gravity, m/s2 in world, e.g. to turn everything over.
    pub fn set_gravity(&mut self, gravity: Vector3<f64>) {
        self.settings.gravity = gravity;
    }

    /// Gives the object the rigid motion of `linear` m/s and `spin` rad/s about its centre
    /// of mass.
    pub fn set_motion(&mut self, linear: &Vector3<f64>, spin: &Vector3<f64>) {
        let centre = self.shell.centre_of_mass();
        for (v, p) in self.shell.velocity.iter_mut().zip(&self.shell.position) {
            *v = linear + spin.cross(&(p - centre));
        }
    }

    /// Puts the object's vertices at `vertices` (world, metres), at rest.
    ///
    /// # Errors
    /// How many vertices it has, when there are not as many, or the index of the first that
    /// is not finite.
    pub fn set_vertices(&mut self, vertices: &[Point3<f64>]) -> Result<(), PlacementFault> {
        let needed = self.shell.position.len();
        if vertices.len() != needed {
            return Err(PlacementFault::Count { given: vertices.len(), needed });
        }
        if let Some(bad) = vertices.iter().position(|p| !p.coords.iter().all(|c| c.is_finite())) {
            return Err(PlacementFault::NotFinite(bad));
        }
        self.release();
        self.shell.rest_at(vertices);
        Ok(())
    }
}
