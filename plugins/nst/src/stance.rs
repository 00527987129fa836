//! How a cloud comes before the network, and what the network is told of it beside its points.
//!
//! Where a point lies in the canonical cube is a matter of how far the whole object reaches,
//! and one view never shows all of it. What bounds the rest is known to whoever looks: how far
//! the seen part reaches, where the camera stands (what faces away from it is hidden, not
//! absent), where the mat is (nothing reaches below it), and how large the object is in metres.

use crate::units::{PER_CANONICAL, PER_METRE, camera_frame};
use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use seeone_core::Similarity;
use seeone_nn::sampling::Point;

/// Columns of a place: a point, the least and the largest coordinates of its cloud, the
/// direction to the camera, the direction up, the point's height and the logarithm of the size.
pub const PLACE: usize = 3 + 6 + 3 + 3 + 1 + 1;
/// Heights above the mat are told within these bounds (network units at true size): what hangs
/// from a gripper hangs anywhere.
const HEIGHTS: (f32, f32) = (-0.5, 3.0);
/// What the logarithm of the size is multiplied by, so that it varies as coordinates do.
const SIZE: f32 = 5.0;

/// The way from `world` to what a network sees.
#[derive(Clone, Copy, Debug)]
pub struct Lens {
    /// `world` (metres) -> network units.
    to_network: Similarity,
    /// -1 to see the mirror image, by x.
    side: f64,
}

impl Lens {
    /// For the coarse network: `points` as they lie, turned to the camera.
    pub fn coarse(points: &[Vector3<f64>], camera: &Point3<f64>) -> Self {
        let frame = Similarity::from_isometry(camera_frame(points, camera), 1.0);
        Self::new(&frame, PER_METRE)
    }

    /// For the refiner: in `pose` (`world` -> centred canonical coordinates).
    pub fn refiner(pose: &Similarity) -> Self {
        Self::new(pose, PER_CANONICAL)
    }

    fn new(pose: &Similarity, units: f64) -> Self {
        Self { to_network: enlarged(pose, units), side: 1.0 }
    }

    /// Turned by `yaw` (rad) about the network's z axis and enlarged by `scale`.
    pub fn turned(self, yaw: f64, scale: f64) -> Self {
        let yaw = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw);
        let turn = Similarity::from_parts(Translation3::identity(), yaw, 1.0);
        Self { to_network: enlarged(&(turn * self.to_network), scale), ..self }
    }

    /// Seen in a mirror where `mirrored`.
    pub fn mirrored(self, mirrored: bool) -> Self {
        Self { side: if mirrored { -1.0 } else { 1.0 }, ..self }
    }

    /// Whether the mirror image is seen.
    pub fn is_mirror(&self) -> bool {
        self.side < 0.0
    }

    /// A point of `world` (metres) as the network takes it.
    pub fn see(&self, point: &Vector3<f64>) -> Point {
        self.sided(&self.to_network.transform_point(&Point3::from(*point)).coords)
    }

    /// What is known of a cloud seen from `camera` (`world`, metres).
    pub fn stance(&self, camera: &Point3<f64>) -> Stance {
        let origin = self.to_network.inverse().transform_point(&Point3::origin());
        let metres = 1.0 / self.to_network.scaling();
        Stance {
            camera: self.see(&camera.coords),
            up: self.sided(&(self.to_network.isometry.rotation * Vector3::z())),
            height_m: origin.z as f32,
            unit_m: metres as f32,
        }
    }

    fn sided(&self, v: &Vector3<f64>) -> Point {
        [(self.side * v.x) as f32, v.y as f32, v.z as f32]
    }
}

fn enlarged(pose: &Similarity, by: f64) -> Similarity {
    Similarity::from_scaling(by) * pose
}

/// What is known of a whole cloud beside its points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stance {
    /// Where the camera stands, network units.
    camera: Point,
    /// The direction up.
    up: [f32; 3],
    /// Height of the network's origin above the mat, metres.
    height_m: f32,
    /// Metres in a network unit.
    unit_m: f32,
}

impl Stance {
    /// Of an object of the same shape and pose, `factor` times as large.
    pub fn resized(self, factor: f64) -> Self {
        let factor = factor as f32;
        Self { height_m: factor * self.height_m, unit_m: factor * self.unit_m, ..self }
    }

    /// `points` of `cloud` with what surrounds them.
    pub fn places<'a>(
        &'a self,
        points: &'a [Point],
        cloud: &[Point],
    ) -> impl Iterator<Item = [f32; PLACE]> + 'a {
        let per_metre = PER_METRE as f32;
        let axes = [0, 1, 2];
        let low = axes.map(|k| cloud.iter().map(|p| p[k]).fold(f32::INFINITY, f32::min));
        let high = axes.map(|k| cloud.iter().map(|p| p[k]).fold(f32::NEG_INFINITY, f32::max));
        let towards = axes.map(|k| self.camera[k] - 0.5 * (low[k] + high[k]));
        let distance = dot(&towards, &towards).sqrt().max(f32::EPSILON);
        let towards = towards.map(|v| v / distance);
        let size = SIZE * (self.unit_m * per_metre).ln();
        points.iter().map(move |point| {
            let height = (self.height_m + self.unit_m * dot(&self.up, point)) * per_metre;
            let height = height.clamp(HEIGHTS.0, HEIGHTS.1);
            let triples = [*point, low, high, towards, self.up];
            let mut place = [0.0; PLACE];
            place[..15].copy_from_slice(triples.as_flattened());
            place[15..].copy_from_slice(&[height, size]);
            place
        })
    }
}

fn dot(a: &[f32; 3], b: &[f32; 3]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A camera at the height of the pose's origin, 1 m off.
    fn pose() -> Similarity {
        let turn = UnitQuaternion::from_scaled_axis(Vector3::new(0.4, -0.8, 0.3));
        Similarity::from_parts(Translation3::new(0.1, -0.2, 0.3), turn, 1.0 / 0.27)
    }

    #[test]
    fn heights_and_size_are_those_of_the_world() {
        let lens = Lens::refiner(&pose());
        let world = [Vector3::new(0.1, 0.2, 0.12), Vector3::new(0.2, 0.1, 0.03)];
        let cloud: Vec<Point> = world.iter().map(|p| lens.see(p)).collect();
        let stance = lens.stance(&Point3::new(0.9, 0.1, 0.7));
        for (place, p) in stance.places(&cloud, &cloud).zip(&world) {
            assert!((place[15] - 10.0 * p.z as f32).abs() < 1e-4);
            assert!(place[16].abs() < 1e-4, "a cube of 0.27 m has size 0");
        }
        let twice = stance.resized(2.0).places(&cloud, &cloud).next().expect("a place");
        assert!((twice[15] - 2.4).abs() < 1e-4 && (twice[16] - 5.0 * 2f32.ln()).abs() < 1e-4);
    }

    #[test]
    fn the_mirror_image_has_a_mirrored_camera() {
        let lens = Lens::refiner(&pose());
        let camera = Point3::new(0.9, 0.1, 0.7);
        let cloud = [Vector3::new(0.1, 0.2, 0.1), Vector3::new(0.2, 0.1, 0.0)];
        let places = |lens: Lens| -> Vec<[f32; PLACE]> {
            let cloud: Vec<Point> = cloud.iter().map(|p| lens.see(p)).collect();
            lens.stance(&camera).places(&cloud, &cloud).collect()
        };
        for (a, b) in places(lens).iter().zip(places(lens.mirrored(true))) {
            for x in [0, 9, 12] {
                assert!((a[x] + b[x]).abs() < 1e-5);
            }
            assert!((a[3] + b[6]).abs() < 1e-5, "the least is the largest, mirrored");
            for same in [1, 2, 4, 5, 7, 8, 10, 11, 13, 14, 15, 16] {
                assert!((a[same] - b[same]).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn the_coarse_network_sees_the_camera_ahead_and_up_up() {
        let points = [Vector3::new(0.5, 0.2, 0.05), Vector3::new(0.7, 0.4, 0.15)];
        let camera = Point3::new(1.5, 0.3, 0.8);
        let lens = Lens::coarse(&points, &camera).turned(0.0, 1.1);
        let cloud: Vec<Point> = points.iter().map(|p| lens.see(p)).collect();
        let stance = lens.stance(&camera).resized(1.1);
        let place = stance.places(&cloud, &cloud).next().expect("a place");
        assert!(place[9].abs() < 0.2 && place[10] < -0.5 && place[14] > 0.99);
        assert!((place[15] - 0.55).abs() < 1e-4 && place[16].abs() < 1e-4);
    }
}
