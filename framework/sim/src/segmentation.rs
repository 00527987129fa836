//! Which pixels of a depth image show the object, on the mat or in the gripper.

mod apart;

pub use apart::groups;

use crate::hand::{FINGER_THICKNESS_M, Hand, PAD_HEEL_M, PAD_TIP_M, PAD_WIDTH_M};
use nalgebra::Point3;
use seeone_core::{Cloud, DepthImage, Pose};

/// Where an object may lie or fall: a box over the table, in `world`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DropZone {
    /// Middle of the zone in the table's plane, metres.
    pub centre_m: [f64; 2],
    /// Half of its edges along x and y, metres.
    pub half_extents_m: [f64; 2],
    /// Where the mat's top is, metres.
    pub floor_m: f64,
    /// Its height over the mat, metres.
    pub height_m: f64,
}

/// What lies lower is taken for the mat, metres: twice the sensor's error.
const MAT_M: f64 = 0.004;
/// A patch smaller than this share of the largest one is taken for noise.
const SMALLEST_SHARE: f64 = 0.2;
/// A smaller patch is the mat's noise, whose patches have up to 140 pixels, and no part of an
/// object, of which some thousand show.
const SMALLEST_PIXELS: usize = 500;
/// Neighbouring pixels whose depths differ by less belong to one patch, metres.
const SAME_PATCH_M: f64 = 0.03;

impl DropZone {
    /// A zone of 0.5 m x 0.5 m x 0.4 m about `centre_m`.
    pub fn around(centre_m: [f64; 2]) -> Self {
        Self { centre_m, half_extents_m: [0.25; 2], floor_m: 0.0, height_m: 0.4 }
    }

    fn holds(&self, p: &Point3<f64>) -> bool {
        (p.x - self.centre_m[0]).abs() < self.half_extents_m[0]
            && (p.y - self.centre_m[1]).abs() < self.half_extents_m[1]
            && (MAT_M..self.height_m).contains(&(p.z - self.floor_m))
    }

    /// Pixels of `image` that show something in the zone above the mat, each with its point
    /// in `world`. `camera` is the camera's pose in `world`.
    ///
    /// The mat's own noise stands out above the threshold here and there, in small islands;
    /// only connected patches of a fair size are kept.
    pub fn segment(&self, image: &DepthImage, camera: &Pose) -> Vec<(usize, Point3<f64>)> {
        segment(image, camera, 1, |_, p| self.holds(p))
    }

    /// The points of the object where it is told by its colour, wherever it is: what cannot be
    /// the mat's, in patches that are large enough for an object. Depths at its outline that fly
    /// between it and what is behind it belong to none.
    pub fn coloured(
        &self,
        image: &DepthImage,
        camera: &Pose,
        is_coloured: impl Fn(usize) -> bool,
    ) -> Cloud {
        let above = |p: &Point3<f64>| p.z - self.floor_m >= MAT_M;
        let holds = |pixel, p: &Point3<f64>| is_coloured(pixel) && above(p);
        let patches = segment(image, camera, SMALLEST_PIXELS, holds);
        Cloud::new(patches.into_iter().map(|(_, p)| p).collect()).unwrap_or_default()
    }

    /// The segmented points alone, of patches that are large enough for an object.
    ///
    /// With `apart_m` several objects may lie there, each farther from the others than so many
    /// metres: the points are then those of the one that shows most of itself.
    pub fn cloud(&self, image: &DepthImage, camera: &Pose, apart_m: Option<f64>) -> Cloud {
        let patches = segment(image, camera, SMALLEST_PIXELS, |_, p| self.holds(p));
        let mut points: Vec<_> = patches.into_iter().map(|(_, p)| p).collect();
        if let Some(apart_m) = apart_m {
            // Of groups of one size the first, as the image is read.
            let largest = groups(points, apart_m).into_iter().rev().max_by_key(Vec::len);
            points = largest.unwrap_or_default();
        }
        Cloud::new(points).unwrap_or_default()
    }
}

/// Where an object that hangs from a gripper may be: around the hand, above the mat, and
/// not where the fingers are. A robot knows all three.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandZone {
    /// Where the hand is, `world`.
    pub hand: Hand,
}

/// No part of a gripped cap is farther from the hand than this, metres.
const REACH_M: f64 = 0.35;
/// What hangs lower is taken for the mat, metres: the sensor's error grows with distance.
const CLEAR_M: f64 = 0.02;
/// What is this near to a finger is taken for the finger, metres: twice the sensor's error.
const FINGER_SKIN_M: f64 = 0.005;

impl HandZone {
    fn holds(&self, p: &Point3<f64>) -> bool {
        let q = self.hand.pose.inverse_transform_point(p);
        let inner = self.hand.opening_m / 2.0;
        let finger = q.x.abs() < PAD_WIDTH_M / 2.0 + FINGER_SKIN_M
            && (PAD_HEEL_M - FINGER_SKIN_M..PAD_TIP_M + FINGER_SKIN_M).contains(&q.z)
            && q.y.abs() < inner + FINGER_THICKNESS_M + FINGER_SKIN_M;
        q.coords.norm() < REACH_M && p.z > CLEAR_M && !finger
    }

    /// Pixels of `image` that show what the hand holds, each with its point in `world`, in
    /// patches of a fair size. `camera` is the camera's pose in `world`.
    pub fn segment(&self, image: &DepthImage, camera: &Pose) -> Vec<(usize, Point3<f64>)> {
        segment(image, camera, 1, |_, p| self.holds(p))
    }
}

/// Pixels whose points `holds` holds, in connected patches of a fair size, none of fewer than
/// `smallest` pixels.
fn segment(
    image: &DepthImage,
    camera: &Pose,
    smallest: usize,
    holds: impl Fn(usize, &Point3<f64>) -> bool,
) -> Vec<(usize, Point3<f64>)> {
    let width = image.intrinsics.width;
    let mut inside: Vec<Option<Point3<f64>>> = image
        .depth_m
        .iter()
        .enumerate()
        .map(|(i, z)| {
            let z = f64::from(*z);
            let usable = z.is_finite() && z > 0.0;
            let point =
                usable.then(|| camera * image.intrinsics.deproject(i % width, i / width, z))?;
            holds(i, &point).then_some(point)
        })
        .collect();
    let patches = patches(&inside, image);
    let largest = patches.iter().map(Vec::len).max().unwrap_or(0);
    let mut kept: Vec<usize> = patches
        .into_iter()
        .filter(|p| p.len() as f64 >= SMALLEST_SHARE * largest as f64 && p.len() >= smallest)
        .flatten()
        .collect();
    kept.sort_unstable();
    kept.into_iter().filter_map(|i| Some((i, inside[i].take()?))).collect()
}

/// Connected patches (eight neighbours, and one missing pixel may be stepped over) of the
/// pixels that are inside.
fn patches(inside: &[Option<Point3<f64>>], image: &DepthImage) -> Vec<Vec<usize>> {
    const STEP: isize = 2;
    let (width, height) = (image.intrinsics.width as isize, image.intrinsics.height as isize);
    let mut seen: Vec<bool> = inside.iter().map(Option::is_none).collect();
    let mut all = Vec::new();
    for start in 0..inside.len() {
        if seen[start] {
            continue;
        }
        seen[start] = true;
        let mut patch = vec![start];
        let mut next = 0;
        while let Some(&pixel) = patch.get(next) {
            next += 1;
            let (column, row) = (pixel as isize % width, pixel as isize / width);
            for r in (row - STEP).max(0)..=(row + STEP).min(height - 1) {
                for c in (column - STEP).max(0)..=(column + STEP).min(width - 1) {
                    let other = (r * width + c) as usize;
                    let gap = (image.depth_m[other] - image.depth_m[pixel]).abs();
                    if !seen[other] && f64::from(gap) < SAME_PATCH_M {
                        seen[other] = true;
                        patch.push(other);
                    }
                }
            }
        }
        all.push(patch);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::depth_camera::{D435I, Noise, capture, looking_at};
    use crate::scenery::{fingers, rectangle, table};
    use nalgebra::{Translation3, UnitQuaternion, Vector3};
    use seeone_core::random::generator;

    #[test]
    fn an_empty_mat_shows_no_object_and_of_two_the_larger_is_shown() {
        let camera = looking_at(&Vector3::new(0.35, -0.2, 0.65), &Vector3::zeros());
        let zone = DropZone { half_extents_m: [0.6; 2], ..DropZone::around([0.0; 2]) };
        let seen = |meshes: &[&seeone_core::TriangleMesh]| {
            let noise = Noise::default();
            let shot = capture(meshes, &camera, &D435I, &noise, &mut generator(3, "t"));
            zone.cloud(&shot.image, &camera, Some(0.08))
        };
        assert!(seen(&[&table()]).is_empty());
        let (large, small) =
            (rectangle([0.1, 0.1], [0.2, 0.2], 0.05), rectangle([-0.15, 0.1], [0.1, 0.1], 0.05));
        let cloud = seen(&[&table(), &small, &large]);
        assert!(cloud.len() > 1000, "{}", cloud.len());
        assert!(cloud.points().iter().all(|p| p.x > -0.02), "nothing of the smaller one");
    }

    #[test]
    fn neither_fingers_nor_table_are_taken_for_what_the_hand_holds() {
        let level = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI);
        let pose = Pose::from_parts(Translation3::new(0.0, 0.0, 0.3), level);
        let hand = Hand { pose, opening_m: 0.002 };
        let sheet = rectangle([0.0, 0.1], [0.15, 0.15], 0.27);
        let camera = looking_at(&Vector3::new(0.3, -0.3, 0.8), &Vector3::new(0.0, 0.0, 0.3));
        let meshes = [&sheet, &table(), &fingers(&hand)];
        let noise = Noise::default();
        let shot = capture(&meshes, &camera, &D435I, &noise, &mut generator(1, "t"));
        let measured = |mesh: u32| {
            let pixels = shot.truth.hits.iter().zip(&shot.image.depth_m);
            pixels.filter(|(h, z)| **z > 0.0 && h.is_some_and(|h| h.mesh == mesh)).count()
        };
        assert!(measured(2) > 200, "the fingers are in view");
        let taken = HandZone { hand }.segment(&shot.image, &camera);
        let of = |mesh: u32| {
            let is = |(pixel, _): &&(usize, Point3<f64>)| {
                shot.truth.hits[*pixel].is_some_and(|h| h.mesh == mesh)
            };
            taken.iter().filter(is).count()
        };
        assert!(of(0) as f64 > 0.9 * measured(0) as f64, "{} of {}", of(0), measured(0));
        assert_eq!(of(1), 0, "pixels of the table");
        assert!((of(2) as f64) < 0.03 * measured(2) as f64, "{} of {}", of(2), measured(2));
    }
}
