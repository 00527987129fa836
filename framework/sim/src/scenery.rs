//! Meshes of what is stiff: the table and the mat on it, a head, a hook, fingers.

use crate::hand::{FINGER_THICKNESS_M, Hand, PAD_HEEL_M, PAD_TIP_M, PAD_WIDTH_M};
use crate::surroundings::{Head, Hook};
use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use seeone_core::hook::{PEG_BALL_RADIUS_M, PEG_RADIUS_M};
use seeone_core::{Pose, TriangleMesh};

/// A rectangle in the plane `z = height`, centred at `centre`, facing up.
pub fn rectangle(centre: [f64; 2], size: [f64; 2], height: f64) -> TriangleMesh {
    let corner = |x: f64, y: f64| {
        Point3::new(centre[0] + 0.5 * x * size[0], centre[1] + 0.5 * y * size[1], height)
    };
    let corners = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    TriangleMesh::new(corners, vec![[0, 1, 2], [0, 2, 3]]).expect("two whole triangles")
}

/// The table top, `z = 0` in `world`.
pub fn table() -> TriangleMesh {
    rectangle([0.0, 0.0], [3.0, 3.0], 0.0)
}

/// A drawn head is smaller than its collider by this, metres: the chords of a mesh that
/// rests on the collider lie inside it, and the skin would show through.
const HEAD_INSET_M: f64 = 0.002;
/// The nose: middle and semi-axes as shares of the cranium's. It tells where the face looks.
const NOSE: [[f64; 3]; 2] = [[0.0, 0.85, -0.49], [0.13, 0.16, 0.145]];
/// Radii of the stand's column and of its foot, metres.
const COLUMN_M: f64 = 0.022;
const FOOT_M: f64 = 0.075;
/// Thickness of the foot, metres.
const FOOT_HEIGHT_M: f64 = 0.012;
/// Sides of the piece of wall that is drawn behind a hook, metres.
const WALL_M: [f64; 2] = [0.6, 0.6];

/// A mannequin's head on a stand on the table, in `world`. The nose and the stand are for
/// the eye alone: nothing collides with them.
pub fn head(head: &Head) -> TriangleMesh {
    let semi_axes = head.size.semi_axes_m();
    let [nose, nose_axes] = NOSE.map(|share| Vector3::from(share).component_mul(&semi_axes));
    let place = head.pose.translation.vector;
    let foot = Point3::new(place.x, place.y, FOOT_HEIGHT_M);
    let ear = |(middle, semi_axes): (Point3<f64>, Vector3<f64>)| {
        let semi_axes = semi_axes.add_scalar(-HEAD_INSET_M);
        ellipsoid(&semi_axes, &(head.pose * Translation3::from(middle)))
    };
    let ([top, bottom], radius) = head.neck();
    let [right, left] = head.ears().map(ear);
    joined(&[
        ellipsoid(&semi_axes.add_scalar(-HEAD_INSET_M), &head.pose),
        ellipsoid(&nose_axes, &(head.pose * Translation3::from(nose))),
        right,
        left,
        rod([head.pose * top, head.pose * bottom], radius - HEAD_INSET_M),
        column(&foot, place.z.max(2.0 * FOOT_HEIGHT_M), COLUMN_M),
        column(&Point3::new(place.x, place.y, 0.0), FOOT_HEIGHT_M, FOOT_M),
    ])
}

/// The two fingers of `hand`, as far as they are pads. The hand behind them is not drawn.
pub fn fingers(hand: &Hand) -> TriangleMesh {
    let [half_x, half_y] = [PAD_WIDTH_M / 2.0, FINGER_THICKNESS_M / 2.0];
    let [middle_z, half_z] = [(PAD_TIP_M + PAD_HEEL_M) / 2.0, (PAD_TIP_M - PAD_HEEL_M) / 2.0];
    let half = Vector3::new(half_x, half_y, half_z);
    joined(&[-1.0, 1.0].map(|side| {
        let middle = Translation3::new(0.0, side * (hand.opening_m / 2.0 + half_y), middle_z);
        cuboid(&half, &(hand.pose * middle))
    }))
}

/// A box of these half edges (metres) about `pose`.
fn cuboid(half_m: &Vector3<f64>, pose: &Pose) -> TriangleMesh {
    let side = |i: u32, axis: u32| if i >> axis & 1 == 1 { 1.0 } else { -1.0 };
    let corner = |i: u32| Vector3::from_fn(|axis, _| side(i, axis as u32) * half_m[axis]);
    let vertices = (0..8).map(|i| pose * Point3::from(corner(i))).collect();
    let faces: [[u32; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    TriangleMesh::new(vertices, triangles).expect("eight corners and six faces")
}

/// A hook and a piece of the wall behind it, in `world`.
pub fn hook(hook: &Hook) -> TriangleMesh {
    let tip = hook.tip();
    let out = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), -std::f64::consts::FRAC_PI_2);
    let wall = rectangle([0.0, 0.0], WALL_M, 0.0);
    let placed = wall.vertices().iter().map(|p| hook.pose * (out * p)).collect();
    joined(&[
        rod([hook.pose * Point3::origin(), tip], PEG_RADIUS_M),
        ellipsoid(&Vector3::repeat(PEG_BALL_RADIUS_M), &Pose::from(tip.coords)),
        TriangleMesh::new(placed, wall.triangles().to_vec()).expect("the same two triangles"),
    ])
}

/// Several meshes as one.
fn joined(meshes: &[TriangleMesh]) -> TriangleMesh {
    let mut vertices: Vec<Point3<f64>> = Vec::new();
    let mut triangles = Vec::new();
    for mesh in meshes {
        let offset = vertices.len() as u32;
        vertices.extend(mesh.vertices());
        triangles.extend(mesh.triangles().iter().map(|t| t.map(|v| v + offset)));
    }
    TriangleMesh::new(vertices, triangles).expect("whole meshes joined are whole")
}

/// An upright cylinder from `bottom` to the height `top`, closed above.
fn column(bottom: &Point3<f64>, top: f64, radius: f64) -> TriangleMesh {
    const AROUND: u32 = 40;
    let mut vertices = vec![Point3::new(bottom.x, bottom.y, top)];
    let mut triangles = Vec::new();
    for i in 0..AROUND {
        let (s, c) = (std::f64::consts::TAU * f64::from(i) / f64::from(AROUND)).sin_cos();
        let on_rim = |z: f64| Point3::new(bottom.x + radius * c, bottom.y + radius * s, z);
        vertices.extend([on_rim(top), on_rim(bottom.z)]);
        let [up, down] = [1 + 2 * i, 2 + 2 * i];
        let [next_up, next_down] = [1 + 2 * ((i + 1) % AROUND), 2 + 2 * ((i + 1) % AROUND)];
        triangles.extend([[0, up, next_up], [up, down, next_down], [up, next_down, next_up]]);
    }
    TriangleMesh::new(vertices, triangles).expect("every index lies on the rims")
}

/// An ellipsoid of these semi-axes (metres) about `pose`.
pub fn ellipsoid(semi_axes_m: &Vector3<f64>, pose: &Pose) -> TriangleMesh {
    globe(|unit| pose * Point3::from(unit.component_mul(semi_axes_m)))
}

/// A round rod between two points, with round ends.
fn rod(ends: [Point3<f64>; 2], radius: f64) -> TriangleMesh {
    let axis = ends[1] - ends[0];
    // Opposite vectors alone have no unique shortest turn; any half turn serves a rod.
    let turn = UnitQuaternion::rotation_between(&Vector3::z(), &axis)
        .unwrap_or_else(|| UnitQuaternion::new(Vector3::x() * std::f64::consts::PI));
    globe(|unit| ends[usize::from(unit.z > 0.0)] + turn * (unit * radius))
}

/// The unit ball's surface as `place` bends it.
fn globe(place: impl Fn(Vector3<f64>) -> Point3<f64>) -> TriangleMesh {
    const AROUND: u32 = 48;
    const DOWN: u32 = 24;
    let mut vertices = Vec::new();
    for i in 0..=DOWN {
        let (sin_i, cos_i) = (std::f64::consts::PI * f64::from(i) / f64::from(DOWN)).sin_cos();
        for j in 0..AROUND {
            let (sin_j, cos_j) =
                (std::f64::consts::TAU * f64::from(j) / f64::from(AROUND)).sin_cos();
            vertices.push(place(Vector3::new(sin_i * cos_j, sin_i * sin_j, cos_i)));
        }
    }
    let vertex = |i: u32, j: u32| i * AROUND + j % AROUND;
    let triangles = (0..DOWN)
        .flat_map(|i| (0..AROUND).map(move |j| (i, j)))
        .flat_map(|(i, j)| {
            let [a, b] = [vertex(i, j), vertex(i, j + 1)];
            let [c, d] = [vertex(i + 1, j), vertex(i + 1, j + 1)];
            [[a, c, d], [a, d, b]]
        })
        .collect();
    TriangleMesh::new(vertices, triangles).expect("every index lies in the grid")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surroundings::HeadSize;

    #[test]
    fn everything_faces_outwards() {
        let ball = ellipsoid(&Vector3::new(0.1, 0.2, 0.3), &Pose::identity());
        let post = column(&Point3::origin(), 0.4, 0.1);
        let block = cuboid(&Vector3::new(0.1, 0.2, 0.3), &Pose::identity());
        let rod = rod([Point3::new(0.1, 0.0, 0.0), Point3::new(-0.1, 0.0, 0.4)], 0.02);
        let (origin, middle) = (Point3::origin(), Point3::new(0.0, 0.0, 0.2));
        for (mesh, middle) in [(ball, origin), (block, origin), (post, middle), (rod, middle)] {
            for i in 0..mesh.triangles().len() {
                let [a, b, c] = mesh.corners(i);
                let normal = (b - a).cross(&(c - a));
                assert!(normal.dot(&(a - middle)) >= -1e-12, "triangle {i} looks inwards");
            }
        }
    }

    #[test]
    fn a_head_stands_on_the_table_inside_its_collider() {
        for (name, size) in HeadSize::NAMED {
            let mesh = head(&Head { pose: Pose::translation(0.3, 0.2, 0.35), size });
            let (low, high) = mesh.bounds();
            assert!(low.z.abs() < 1e-12);
            let top = 0.35 + size.semi_axes_m().z - HEAD_INSET_M;
            assert!((high.z - top).abs() < 1e-9, "{name}");
            assert!(high.x - 0.3 > size.semi_axes_m().x + 0.005, "{name}: the ears are drawn");
        }
    }

    #[test]
    fn a_hook_sticks_out_of_its_wall() {
        let standing = Hook::coat(Pose::translation(0.0, 0.4, 0.5));
        let (low, high) = hook(&standing).bounds();
        assert!((high.y - (standing.tip().y + PEG_BALL_RADIUS_M)).abs() < 1e-3);
        assert!((high.z - low.z - WALL_M[1]).abs() < 1e-9);
    }
}
