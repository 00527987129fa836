//! Putting the object, or gravity, elsewhere; pinning and pushing vertices.

use super::{PlacementFault, World};
use crate::shell::{Momentum, Shell};
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

    /// Puts the object's vertices at `vertices` (world, metres), at rest. A grip is let go;
    /// what is pinned stays pinned, at its new place.
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

    /// Pins `vertices` where they are, in place of all that were pinned before; an empty list
    /// frees them. Nothing moves a pinned vertex, however hard it pulls, and a rigid part
    /// that has pinned vertices stays with them.
    ///
    /// A vertex has one master: a grip is let go, and a grip that the hand forms later
    /// takes the pins' place.
    ///
    /// # Errors
    /// When the object has no such vertex; then nothing changes.
    pub fn pin(&mut self, vertices: &[usize]) -> Result<(), PlacementFault> {
        vertices.iter().try_for_each(|vertex| self.known(*vertex))?;
        self.release();
        self.shell.pin(vertices);
        Ok(())
    }

    /// Pushes `vertex` with `force_n` (world, N) from now on, in place of what pushed it
    /// before; zero ends it. A pinned or gripped vertex passes the push on to what holds it.
    ///
    /// # Errors
    /// When the object has no such vertex or the force is not finite; then nothing changes.
    pub fn push(&mut self, vertex: usize, force_n: Vector3<f64>) -> Result<(), PlacementFault> {
        self.known(vertex)?;
        if !force_n.iter().all(|c| c.is_finite()) {
            return Err(PlacementFault::NotFinite(vertex));
        }
        self.pushes.retain(|(pushed, _)| *pushed != vertex);
        if force_n != Vector3::zeros() {
            self.pushes.push((vertex, force_n));
        }
        Ok(())
    }

    fn known(&self, vertex: usize) -> Result<(), PlacementFault> {
        let vertices = self.shell.position.len();
        let known = vertex < vertices;
        if known { Ok(()) } else { Err(PlacementFault::Unknown { vertex, vertices }) }
    }
}

/// What `pushes` do to a shell that has just been predicted, in a substep of `h` seconds.
/// Adds what they gave to `given`.
pub(super) fn push(
    shell: &mut Shell,
    pushes: &[(usize, Vector3<f64>)],
    h: f64,
    given: &mut Momentum,
) {
    for (vertex, force_n) in pushes {
        shell.position[*vertex] += force_n * (shell.inverse_mass[*vertex] * h * h);
        given.add(&(force_n * h), &shell.position[*vertex]);
    }
}
