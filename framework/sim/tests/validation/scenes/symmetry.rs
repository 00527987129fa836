//! The same motion at another scale, turned, and shifted.

use super::check::Check;
use super::common::{a_cap, advance};
use super::plate::Plate;
use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use seeone_core::Pose;
use seeone_core::random::{generator, rotation};
use seeone_sim::{Material, Settings, Surroundings, World};

const GRAVITY: f64 = 9.81;

/// A sheet of `scale` times 0.1 m, pinned by a corner, let go level and turned by `turn`
/// together with gravity: where its vertices are after 1 s.
fn swung(scale: f64, turn: &UnitQuaternion<f64>) -> Vec<Point3<f64>> {
    let material = Material {
        density_kg_m2: 0.3 / scale.powi(2),
        bending_n_m: 1e-4 * scale.powi(2),
        thickness_m: 1e-3 * scale,
    };
    let plate = Plate { edge_m: 0.01 * scale, strips: 10, across: 8, material };
    let settings = Settings {
        gravity: turn * Vector3::z() * -GRAVITY * scale,
        self_contact: false,
        ..Settings::default()
    };
    let placed = Pose::from_parts(Translation3::identity(), *turn);
    let mut world = World::new(&plate.object(), &placed, Surroundings::default(), settings);
    world.pin(&[0, 1]).unwrap();
    advance(&mut world, 1.0);
    world.vertices().to_vec()
}

/// A cap let go 0.25 m over the table, if there is one, all of it and gravity moved by `moved`:
/// where its vertices are after 0.4 s.
fn dropped(moved: &Pose, table: bool) -> Vec<Point3<f64>> {
    let placed = Pose::new(Vector3::new(0.0, 0.0, 0.25), Vector3::new(2.0, 0.4, 0.2));
    let surroundings = Surroundings { table, ..Default::default() };
    let gravity = moved.rotation * Vector3::z() * -GRAVITY;
    let settings = Settings { gravity, ..Settings::default() };
    let mut world = World::new(&a_cap(), &(moved * placed), surroundings, settings);
    world.set_motion(&Vector3::zeros(), &(moved.rotation * Vector3::new(1.0, 2.0, 3.0)));
    advance(&mut world, 0.4);
    world.vertices().to_vec()
}

/// Largest distance between the vertices of `a` and what `map` makes of those of `b`.
fn apart(a: &[Point3<f64>], b: &[Point3<f64>], map: impl Fn(&Point3<f64>) -> Point3<f64>) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - map(b)).norm()).fold(0.0, f64::max)
}

/// Mechanics knows no scale and no direction. A swinging sheet at 2.3 times the lengths and
/// gravity, with a density and a bending stiffness that leave every force what it was times
/// 2.3; the same sheet turned, with gravity; a falling cap turned and shifted, with gravity;
/// and one that drops onto the table, turned about the vertical and shifted along it.
/// Largest distance of a vertex from where it should be, as a share of the size.
///
/// The cap touches the table after 0.2 s. From then on what rounding left grows tenfold in
/// every 0.1 s, as in any crumpling, and would be 1e-6 after 0.5 s.
pub fn symmetries() -> Vec<Check> {
    let check = |quantity, apart, size| {
        Check::at_most(quantity, "the same motion", "of the size", apart / size, 1e-6)
    };
    let (still, turn) = (UnitQuaternion::identity(), rotation(&mut generator(1, "turn")));
    let sheet = swung(1.0, &still);
    let scaled = apart(&swung(2.3, &still), &sheet, |p| p * 2.3);
    let turned = apart(&swung(1.0, &turn), &sheet, |p| turn * p);
    let moved = Pose::from_parts(Translation3::new(0.3, -0.2, 0.1), turn);
    let falling = dropped(&Pose::identity(), false);
    let fallen = apart(&dropped(&moved, false), &falling, |p| moved * p);
    let yawed = Pose::new(Vector3::new(0.3, -0.2, 0.0), Vector3::z());
    let lying = dropped(&Pose::identity(), true);
    let laid = apart(&dropped(&yawed, true), &lying, |p| yawed * p);
    vec![
        check("swinging sheet at 2.3 times the scale, 1 s", scaled, 0.23),
        check("swinging sheet turned with gravity, 1 s", turned, 0.1),
        check("falling, spinning cap turned and shifted with gravity, 0.4 s", fallen, 0.27),
        check("cap dropped on the table, yawed and shifted, 0.4 s", laid, 0.27),
    ]
}
