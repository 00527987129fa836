//! What a contact does to the vertices of a shell.

use super::Touch;
use crate::shell::{Momentum, Shell};
use nalgebra::Point3;

/// Pushes the `vertices` that `touch` finds inside a body out of it, in a substep of `h`
/// seconds with the Coulomb coefficient `friction`. Adds what it gave the shell to `given`.
///
/// A vertex of a rigid part first moves the part as a body: alone it is too light to
/// carry what the part weighs, and the part would sink in and bend about it. Whatever is
/// still inside then comes out by itself.
pub fn push_out(
    shell: &mut Shell,
    vertices: impl Iterator<Item = usize> + Clone,
    touch: impl Fn(&Point3<f64>) -> Option<Touch>,
    friction: f64,
    h: f64,
    given: &mut Momentum,
) {
    for vertex in vertices.clone() {
        if let Some(touch) = touch(&shell.position[vertex])
            && let Some(yielding) = shell.yielding(vertex)
        {
            let moved = shell.position[vertex] - shell.previous[vertex];
            let impulse = touch.impulse(&moved, &yielding, friction, h);
            shell.push_part(vertex, &impulse);
            given.add(&(impulse / h), &shell.position[vertex]);
        }
    }
    for vertex in vertices {
        if shell.inverse_mass[vertex] > 0.0
            && let Some(touch) = touch(&shell.position[vertex])
        {
            let moved = shell.position[vertex] - shell.previous[vertex];
            let (correction, _) = touch.correction(&moved, friction, h);
            shell.position[vertex] += correction;
            given.add(&(correction * (shell.mass[vertex] / h)), &shell.position[vertex]);
        }
    }
}
