//! Friction of a shell on rigid bodies, against what is known of it.

use super::*;
use crate::contact::Shape;
use crate::contact::capsule::Capsule;
use crate::contact::ellipsoid::Ellipsoid;
use crate::object::{Material, Object, Region};
use nalgebra::{Translation3, UnitQuaternion, Vector3};
use seeone_core::random::{direction, generator, uniform};
use seeone_core::{Pose, TriangleMesh};

/// Radius of the cylinder, metres.
const RADIUS_M: f64 = 0.03;
/// Length of the strip's free ends, metres.
const END_M: f64 = 0.03;
/// Squares along the strip and their sides, metres.
const SQUARES: u32 = 40;
const SIDE_M: f64 = (std::f64::consts::PI * RADIUS_M + 2.0 * END_M) / SQUARES as f64;
/// Mass of the light end, kg; a row of squares between the ends weighs a 500th of it.
const LIGHT_KG: f64 = 0.05;

/// A limp strip, two squares wide, draped over a cylinder along x, whose ends weigh
/// `ratio` to one.
fn draped(ratio: f64) -> Object {
    let at = |i: u32, j: u32| {
        let along = f64::from(i) * SIDE_M - END_M;
        let angle = (along / RADIUS_M).clamp(0.0, std::f64::consts::PI);
        let hang = if along < 0.0 { along } else { (angle * RADIUS_M - along).min(0.0) };
        let x = (f64::from(j) - 1.0) * SIDE_M;
        Point3::new(x, -RADIUS_M * angle.cos(), RADIUS_M * angle.sin() + hang)
    };
    let vertices = (0..=SQUARES).flat_map(|i| (0..3).map(move |j| at(i, j))).collect();
    let (mut triangles, mut regions) = (Vec::new(), Vec::new());
    for (i, j) in (0..SQUARES).flat_map(|i| (0..2).map(move |j| (i, j))) {
        let a = 3 * i + j;
        triangles.extend([[a, a + 3, a + 1], [a + 1, a + 3, a + 4]]);
        regions.extend(
            [match i {
                0 => Region::Front,
                i if i + 1 == SQUARES => Region::Hem,
                _ => Region::Crown,
            }; 2],
        );
    }
    let cloth = |kg: f64| Material {
        density_kg_m2: kg / (2.0 * SIDE_M * SIDE_M),
        bending_n_m: 1e-9,
        thickness_m: 0.001,
    };
    // In the order of `Region::ALL`: crown, front, brim, hem.
    let between = cloth(LIGHT_KG / 500.0);
    let materials = [between, cloth(LIGHT_KG), between, cloth(LIGHT_KG * ratio)];
    let mesh = TriangleMesh::new(vertices, triangles).expect("a whole strip");
    Object::new("strip", "strip", mesh, regions, materials, 0.0).expect("a strip")
}

/// How far the heavy end sinks within half a second, after half a second in which the
/// strip takes up its load, metres.
fn sinks(ratio: f64, friction: f64) -> f64 {
    let object = draped(ratio);
    let mut shell = Shell::new(&object, &Pose::identity());
    let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), std::f64::consts::FRAC_PI_2);
    let cylinder = Body {
        shape: Shape::Capsule(Capsule { half_length: 0.1, radius: RADIUS_M }),
        pose: Pose::from_parts(Translation3::identity(), turn),
        friction,
        probes: Probes::Vertices,
    };
    let mut bodies = Bodies::new(vec![cylinder], &[]);
    let (substeps, mut given) = (300, Momentum::zero());
    let h = FRAME_S / f64::from(substeps);
    let heavy = shell.position.len() - 2;
    let mut start = 0.0;
    for frame in 0..60 {
        if frame == 30 {
            start = shell.position[heavy].z;
        }
        bodies.begin_frame(&shell);
        for _ in 0..substeps {
            shell.predict(h, &Vector3::new(0.0, 0.0, -9.81), 2.0);
            shell.solve(h);
            bodies.solve(&mut shell, h, &mut given);
            shell.finish(h);
        }
    }
    start - shell.position[heavy].z
}

/// The capstan equation (Euler, Eytelwein): a rope over half a turn slips when one end
/// pulls exp(pi mu) times as much as the other.
#[test]
fn a_strip_over_a_cylinder_slips_at_the_capstan_ratio() {
    for friction in [0.2f64, 0.3] {
        let limit = (friction * std::f64::consts::PI).exp();
        let held = sinks(0.95 * limit, friction);
        assert!(held.abs() < 2e-3, "friction {friction}: sank by {held} m below the limit");
        let slipped = sinks(1.05 * limit, friction);
        assert!(slipped > 0.1, "friction {friction}: sank by {slipped} m only above the limit");
    }
}

#[test]
fn what_is_left_out_of_a_frame_cannot_be_touched_in_it() {
    let turn = UnitQuaternion::from_euler_angles(0.3, -0.5, 0.8);
    let pose = Pose::from_parts(Translation3::new(0.1, 0.0, 0.2), turn);
    let shapes = [
        Shape::Ellipsoid(Ellipsoid { semi_axes: Vector3::new(0.014, 0.018, 0.030) }),
        Shape::Capsule(Capsule { half_length: 0.045, radius: 0.006 }),
        Shape::HalfSpace,
    ];
    let mut rng = generator(4, "bodies");
    let mut left_out = 0;
    for shape in shapes {
        let body = Body { shape, pose, friction: 0.3, probes: Probes::Samples };
        for _ in 0..2000 {
            let p = pose * Point3::from(direction(&mut rng) * uniform(&mut rng, 0.0, 0.1));
            if !body.may_reach(&p, 0.01) {
                assert!(body.distance(&p) >= 0.01, "{shape:?} at {p}");
                left_out += 1;
            }
            assert_eq!(body.touch(&p).is_some(), body.distance(&p) < 0.0);
        }
    }
    assert!(left_out > 1000);
}
