//! Falling, and sliding down a slope.

use super::check::Check;
use super::common::{a_cap, advance, floating, sheet};
use nalgebra::Vector3;
use seeone_core::Pose;
use seeone_sim::{Frictions, Settings, Surroundings, World};

const GRAVITY: f64 = 9.81;

/// A cap falls for 0.4 s without drag: g t^2 / 2, and no strain.
pub fn falls() -> Vec<Check> {
    let settings = Settings { gravity: Vector3::new(0.0, 0.0, -GRAVITY), ..floating() };
    let mut world = World::new(&a_cap(), &Pose::identity(), Surroundings::default(), settings);
    let start = world.centre_of_mass();
    advance(&mut world, 0.4);
    let fallen = start.z - world.centre_of_mass().z;
    let expected = GRAVITY * 0.4 * 0.4 / 2.0;
    vec![
        Check::share("free fall of a cap, 0.4 s", "g t^2 / 2", "m", (expected, fallen), 0.005),
        Check::at_most("worst strain of the falling cap", "0", "", world.strain().1, 1e-6),
    ]
}

/// How far a sheet slides down a slope of `degrees` within one second.
fn slides(friction: f64, degrees: f64) -> f64 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let frictions = Frictions { table: friction, ..Default::default() };
    let surroundings = Surroundings { table: true, frictions, ..Default::default() };
    let down = |x, z| Vector3::new(x, 0.0, z) * GRAVITY;
    let settings = Settings { gravity: down(0.0, -1.0), ..floating() };
    let mut world = World::new(&sheet(4), &Pose::identity(), surroundings, settings);
    advance(&mut world, 0.5);
    let start = world.centre_of_mass();
    world.set_gravity(down(sin, -cos));
    advance(&mut world, 1.0);
    world.centre_of_mass().x - start.x
}

/// Coulomb's slope: a sheet sticks half a degree below atan(mu), and above slides by
/// g (sin a - mu cos a) t^2 / 2 within t = 1 s.
pub fn slopes() -> Vec<Check> {
    let mut checks = Vec::new();
    for friction in [0.3, 0.5f64] {
        let limit = friction.atan().to_degrees();
        let crept = slides(friction, limit - 0.5).abs();
        let quantity = format!("sheet on a slope, mu {friction}, 0.5 degrees below atan(mu)");
        checks.push(Check::at_most(quantity, "0", "m", crept, 1e-5));
        for degrees in [limit + 1.0, 35.0, 45.0f64] {
            let (sin, cos) = degrees.to_radians().sin_cos();
            let slid = (GRAVITY * (sin - friction * cos) / 2.0, slides(friction, degrees));
            let quantity = format!("the same, slope of {degrees:.1} degrees, 1 s");
            checks.push(Check::share(quantity, "g (sin a - mu cos a) t^2 / 2", "m", slid, 0.01));
        }
    }
    checks
}
