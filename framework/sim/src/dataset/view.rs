//! One look at the world: where the camera stands, and the labelled points it gives.

use crate::depth_camera::{D435I, Noise, capture, looking_at};
use crate::hand::Hand;
use crate::scenery;
use crate::segmentation::{DropZone, HandZone};
use crate::world::World;
use nalgebra::Vector3;
use rand::seq::SliceRandom;
use seeone_core::Pose;
use seeone_core::frames::CanonicalObject;
use seeone_core::random::{Generator, uniform};

/// A view keeps a random subset of at most this many points.
pub const MOST_POINTS: usize = 2048;
/// A view with fewer points is none.
const FEWEST_POINTS: usize = 200;
/// How far the camera stands from what it looks at, metres.
const DISTANCE_M: (f64, f64) = (0.6, 0.9);
/// How far up it stands over the mat, radians.
const MAT_ELEVATION_RAD: (f64, f64) = (0.61, 1.05);
/// The same over a lifted hand: a camera that looks at the mat from the side sees it
/// nearly level.
const HAND_ELEVATION_RAD: (f64, f64) = (0.1, 0.9);
/// Middle of the zone over the mat that the camera looks at, metres.
const MAT_MIDDLE_M: f64 = 0.03;
/// What hangs from a hand hangs about so far below it, metres.
const HANGS_M: f64 = 0.05;
/// The camera looks past what it looks at by so much at most, metres.
const MISSES_BY_M: f64 = 0.03;

/// Observed points and where they belong.
pub struct View {
    /// Points in `world`, metres.
    pub points: Vec<[f32; 3]>,
    /// Their canonical coordinates.
    pub nocs: Vec<[f32; 3]>,
}

/// A camera that looks at the drop zone from a random side.
pub fn camera_at_mat(rng: &mut Generator) -> Pose {
    draw_camera(Vector3::z() * MAT_MIDDLE_M, MAT_ELEVATION_RAD, rng)
}

/// A camera that looks at what a hand holds from a random side.
pub fn camera_at_hand(hand: &Hand, rng: &mut Generator) -> Pose {
    let below = hand.pose.translation.vector - Vector3::z() * HANGS_M;
    draw_camera(below, HAND_ELEVATION_RAD, rng)
}

fn draw_camera(middle: Vector3<f64>, elevation_rad: (f64, f64), rng: &mut Generator) -> Pose {
    let azimuth = uniform(rng, 0.0, std::f64::consts::TAU);
    let elevation = uniform(rng, elevation_rad.0, elevation_rad.1);
    let distance = uniform(rng, DISTANCE_M.0, DISTANCE_M.1);
    let away = Vector3::new(
        azimuth.cos() * elevation.cos(),
        azimuth.sin() * elevation.cos(),
        elevation.sin(),
    );
    let mut miss = || uniform(rng, -MISSES_BY_M, MISSES_BY_M);
    let target = middle + Vector3::new(miss(), miss(), 0.0);
    looking_at(&(target + away * distance), &target)
}

/// One look at the world; nothing when too little of the object is seen. What a robot
/// knows tells which pixels are the object's: the mat, or its own hand.
pub fn take(
    world: &World,
    canonical: &CanonicalObject,
    camera: &Pose,
    rng: &mut Generator,
) -> Option<View> {
    let mut meshes = vec![world.mesh(), scenery::table()];
    meshes.extend(world.hand().map(scenery::fingers));
    let shot = capture(&meshes.iter().collect::<Vec<_>>(), camera, &D435I, &Noise::default(), rng);
    let segment = match world.hand() {
        Some(hand) => HandZone { hand: *hand }.segment(&shot.image, camera),
        None => DropZone::around([0.0, 0.0]).segment(&shot.image, camera),
    };
    // What else the segmentation lets through has no canonical place.
    let seen: Vec<_> = segment
        .into_iter()
        .filter_map(|(pixel, point)| {
            let hit = shot.truth.hits[pixel].filter(|h| h.mesh == 0)?;
            let corners = canonical.triangles[hit.triangle as usize]
                .map(|v| Vector3::from(canonical.vertices[v as usize]));
            Some((point.coords, hit.interpolate(corners)))
        })
        .collect();
    if seen.len() < FEWEST_POINTS {
        return None;
    }
    let mut order: Vec<usize> = (0..seen.len()).collect();
    let (chosen, _) = order.partial_shuffle(rng, MOST_POINTS);
    chosen.sort_unstable();
    let single = |v: Vector3<f64>| -> [f32; 3] { v.map(|c| c as f32).into() };
    let points = chosen.iter().map(|i| single(seen[*i].0)).collect();
    let nocs = chosen.iter().map(|i| single(seen[*i].1)).collect();
    Some(View { points, nocs })
}
