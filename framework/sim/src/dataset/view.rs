//! One drop: simulated, and seen while it falls and when it rests.

use super::Plan;
use crate::depth_camera::{D435I, Noise, capture, looking_at};
use crate::drop::Drop;
use crate::scenery;
use crate::segmentation::DropZone;
use crate::surroundings::Surroundings;
use crate::world::{FRAME_S, Settings, World};
use nalgebra::Vector3;
use rand::seq::SliceRandom;
use seeone_core::frames::{CanonicalObject, Frame, FrameInfo};
use seeone_core::random::{Generator, generator, uniform};

/// A frame keeps a random subset of at most this many points.
pub const MOST_POINTS: usize = 2048;
/// A frame with fewer points is left out.
const FEWEST_POINTS: usize = 200;
/// One drop of so many is also seen while it falls: a quarter of the frames.
const FALLING_ONE_OF: usize = 3;
/// When a falling object is seen, seconds after it was let go.
const FALLING_S: (f64, f64) = (0.12, 0.45);
/// A drop is given this long to come to rest, seconds.
const SETTLE_S: f64 = 5.0;
/// Substeps of a frame; nothing is gripped here.
const SUBSTEPS: usize = 20;
/// Where the camera stands: elevation (radians) and distance (metres) of the zone's centre.
const ELEVATION_RAD: (f64, f64) = (0.61, 1.05);
const DISTANCE_M: (f64, f64) = (0.6, 0.9);

/// Simulates drop number `drop` of object `number` and takes its frames.
pub fn frames_of_drop(
    plan: &Plan,
    number: usize,
    canonical: &CanonicalObject,
    drop: usize,
) -> Vec<Frame> {
    let object = &plan.objects[number];
    let mut rng = generator(plan.seed, &format!("{}/drop-{drop}", object.name()));
    let surroundings = Surroundings { table: true, ..Surroundings::default() };
    let settings = Settings { substeps: SUBSTEPS, ..Settings::default() };
    let mut world = Drop::draw([0.0, 0.0], &mut rng).begin(object, surroundings, settings);
    let mut frames = Vec::new();
    let mut look = |world: &World, settled: bool, rng: &mut Generator| {
        for _ in 0..plan.views {
            let camera = draw_camera(rng);
            let info = FrameInfo {
                object: number,
                drop,
                seconds: world.time(),
                settled,
                camera_xyz_m: camera.translation.vector.into(),
            };
            frames.extend(take(world, canonical, &camera, info, rng));
        }
    };
    let falling_s = uniform(&mut rng, FALLING_S.0, FALLING_S.1);
    if drop.is_multiple_of(FALLING_ONE_OF) {
        for _ in 0..(falling_s / FRAME_S).round() as usize {
            world.advance();
        }
        look(&world, false, &mut rng);
    }
    let settled = world.settle(SETTLE_S).at_rest;
    look(&world, settled, &mut rng);
    if world.fault().is_some() { Vec::new() } else { frames }
}

/// A camera that looks at the zone from a random side.
fn draw_camera(rng: &mut Generator) -> seeone_core::Pose {
    let azimuth = uniform(rng, 0.0, std::f64::consts::TAU);
    let elevation = uniform(rng, ELEVATION_RAD.0, ELEVATION_RAD.1);
    let distance = uniform(rng, DISTANCE_M.0, DISTANCE_M.1);
    let away = Vector3::new(
        azimuth.cos() * elevation.cos(),
        azimuth.sin() * elevation.cos(),
        elevation.sin(),
    );
    let target = Vector3::new(uniform(rng, -0.03, 0.03), uniform(rng, -0.03, 0.03), 0.03);
    looking_at(&(target + away * distance), &target)
}

/// One look at the world; nothing when too little of the object is seen.
fn take(
    world: &World,
    canonical: &CanonicalObject,
    camera: &seeone_core::Pose,
    info: FrameInfo,
    rng: &mut Generator,
) -> Option<Frame> {
    let (mesh, table) = (world.mesh(), scenery::table());
    let shot = capture(&[&mesh, &table], camera, &D435I, &Noise::default(), rng);
    // The mat's pixels that the segmentation lets through have no canonical place.
    let seen: Vec<_> = DropZone::around([0.0, 0.0])
        .segment(&shot.image, camera)
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
    Some(Frame { info, points, nocs })
}
