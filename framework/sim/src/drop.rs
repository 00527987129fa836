//! Dropping an object onto the mat: how every trial and every training frame begins.

use crate::object::Object;
use crate::surroundings::Surroundings;
use crate::world::{Settings, World};
use nalgebra::{Translation3, UnitQuaternion, Vector3};
use rand::Rng;
use seeone_core::Pose;
use seeone_core::random::{direction, rotation, uniform};

/// Height of the lowest point at which an object is let go, metres.
const HEIGHT_M: (f64, f64) = (0.10, 0.15);
/// Largest spin at the start, rad/s.
const LARGEST_SPIN_RAD_S: f64 = 2.0;

/// How an object is let go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drop {
    /// Where over the table, `world`, metres.
    pub centre_m: [f64; 2],
    /// Its orientation: object frame -> `world`.
    pub rotation: UnitQuaternion<f64>,
    /// Its angular velocity in `world`, rad/s.
    pub spin_rad_s: Vector3<f64>,
    /// Height of its lowest point over the mat, metres.
    pub height_m: f64,
}

impl Drop {
    /// A drop over `centre_m` with an orientation uniform over all rotations and a small
    /// spin.
    pub fn draw(centre_m: [f64; 2], rng: &mut impl Rng) -> Self {
        let rotation = rotation(rng);
        let spin_rad_s = direction(rng) * uniform(rng, 0.0, LARGEST_SPIN_RAD_S);
        let height_m = uniform(rng, HEIGHT_M.0, HEIGHT_M.1);
        Self { centre_m, rotation, spin_rad_s, height_m }
    }

    /// The pose (object frame -> `world`) in which `object` is let go: the middle of its
    /// bounding box over the centre, its lowest vertex at the height.
    pub fn pose(&self, object: &Object) -> Pose {
        let (low, high) = object.mesh().bounds();
        let middle = self.rotation * nalgebra::center(&low, &high);
        let lowest = object
            .mesh()
            .vertices()
            .iter()
            .map(|v| (self.rotation * v).z)
            .fold(f64::INFINITY, f64::min);
        let place = Translation3::new(
            self.centre_m[0] - middle.x,
            self.centre_m[1] - middle.y,
            self.height_m - lowest,
        );
        Pose::from_parts(place, self.rotation)
    }

    /// A world in which `object` has just been let go.
    pub fn begin(&self, object: &Object, surroundings: Surroundings, settings: Settings) -> World {
        let mut world = World::new(object, &self.pose(object), surroundings, settings);
        world.set_motion(&Vector3::zeros(), &self.spin_rad_s);
        world
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::category::cap;
    use nalgebra::Point3;
    use seeone_core::random::generator;

    fn lowest(points: &[Point3<f64>]) -> f64 {
        points.iter().map(|p| p.z).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn a_dropped_cap_comes_to_rest_on_the_mat_near_its_place() {
        let object = cap::named("cap-validation-00").expect("a cap");
        let drop = Drop::draw([0.4, -0.1], &mut generator(5, "drop"));
        let settings = Settings::default();
        let table = Surroundings { table: true, ..Surroundings::default() };
        let mut world = drop.begin(&object, table, settings);
        assert!((lowest(world.vertices()) - drop.height_m).abs() < 1e-9);
        world.settle(6.0);
        assert!(world.fault().is_none());
        assert!(lowest(world.vertices()).abs() < 0.004);
        let centre = world.centre_of_mass();
        assert!((centre.x - 0.4).hypot(centre.y + 0.1) < 0.2, "{centre}");
    }
}
