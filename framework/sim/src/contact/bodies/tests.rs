//! Friction of a shell on rigid bodies, against what is known of it.

use super::*;
use crate::contact::Shape;
use crate::contact::capsule::Capsule;
use crate::object::{Material, Object, Region};
use nalgebra::{Translation3, UnitQuaternion, Vector3};
use seeone_core::{Pose, TriangleMesh};

/// Radius of the cylinder, metres.
const RADIUS_M: f64 = 0.03;
/// Length of the strip's free ends, metres.
const END_M: f64 = 0.03;
/// Squares along the strip and their sides, metres.
const SQUARES: u32 = 40;
const SIDE_M: f64 = (std::f64::consts::PI * RADIUS_M + 2.0 * END_M) / SQUARES as f64;
/// Mass of the light end, kg, and of all between the ends, a small share of it.
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
    let between = cloth(LIGHT_KG / 5000.0);
    let materials = [between, cloth(LIGHT_KG), between, cloth(LIGHT_KG * ratio)];
    let mesh = TriangleMesh::new(vertices, triangles).expect("a whole strip");
    Object::new("strip", "strip", mesh, regions, materials, 0.0).expect("a strip")
}

/// How far the heavy end sinks within half a second, metres.
fn sinks(ratio: f64, friction: f64) -> f64 {
    let object = draped(ratio);
    let mut shell = Shell::new(&object, &Pose::identity());
    let turn = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), std::f64::consts::FRAC_PI_2);
    let cylinder = Body {
        shape: Shape::Capsule(Capsule { half_length: 0.1, radius: RADIUS_M }),
        pose: Pose::from_parts(Translation3::identity(), turn),
        friction,
        resolution: Resolution::Vertices,
    };
    let mut bodies = Bodies::new(vec![cylinder], &[]);
    let (substeps, mut given) = (100, Momentum::zero());
    let h = FRAME_S / f64::from(substeps);
    let heavy = shell.position.len() - 2;
    let mut start = 0.0;
    for frame in 0..45 {
        if frame == 15 {
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

#[test]
fn zz() {
    for mu in [0.2, 0.3, 0.5] {
        let e = (mu * std::f64::consts::PI as f64).exp();
        for f in [0.8, 0.9, 0.95, 1.0, 1.05, 1.1, 1.2] {
            println!("{mu} {e:.3} {f} {:.5}", sinks(e * f, mu));
        }
    }
}
