//! Each fault of the camera shows, and shows where it should.

use super::*;
use nalgebra::Point3;
use seeone_core::random::generator;

fn table() -> TriangleMesh {
    crate::scenery::table()
}

fn above(angle_deg: f64) -> Pose {
    let a = angle_deg.to_radians();
    looking_at(&(Vector3::new(0.0, -a.cos(), a.sin()) * 0.7), &Vector3::zeros())
}

/// Errors of the measured pixels of a table, row by row, metres.
fn errors(camera: &Pose) -> Vec<f64> {
    let shot = capture(&[&table()], camera, &D435I, &Noise::default(), &mut generator(1, "t"));
    let pixels = shot.image.depth_m.iter().zip(&shot.truth.hits);
    let measured = pixels.filter(|(z, _)| **z > 0.0);
    measured.filter_map(|(z, hit)| Some(f64::from(*z) - hit.as_ref()?.depth_m)).collect()
}

fn deviation(errors: &[f64]) -> f64 {
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}

/// A shot from 0.7 m straight down at a plate that floats 0.15 m over the table.
fn plate() -> Capture {
    let plate = crate::scenery::rectangle([0.0; 2], [0.2; 2], 0.15);
    let meshes = [&plate, &table()];
    capture(&meshes, &above(90.0), &D435I, &Noise::default(), &mut generator(1, "t"))
}

/// The columns in which the plate begins and ends, in the image's middle row.
fn plate_columns(shot: &Capture) -> (usize, usize) {
    let on_plate = |c: &usize| shot.truth.at(*c as isize, 240).is_some_and(|h| h.mesh == 0);
    let mut columns = (0..D435I.width).filter(on_plate);
    let first = columns.next().expect("the plate is seen");
    (first, columns.next_back().expect("the plate is wide"))
}

/// Share of the pixels of `columns` in the middle rows that were not measured.
fn lost(shot: &Capture, columns: std::ops::Range<usize>) -> f64 {
    let pixels: Vec<usize> =
        (220..260).flat_map(|row| columns.clone().map(move |c| row * D435I.width + c)).collect();
    let missing = pixels.iter().filter(|p| shot.image.depth_m[**p] == 0.0).count();
    missing as f64 / pixels.len() as f64
}

#[test]
fn the_shadow_lies_on_the_left_of_what_stands_in_front() {
    let shot = plate();
    let (first, last) = plate_columns(&shot);
    // 384 px 0.05 m (1 / 0.55 m - 1 / 0.7 m)
    assert!(lost(&shot, first - 7..first) > 0.95, "7.5 pixels are hidden from the second imager");
    assert!(lost(&shot, first - 20..first - 10) < 0.05);
    assert!(lost(&shot, last + 3..last + 10) < 0.05, "no shadow on the right");
}

#[test]
fn a_band_on_the_left_is_outside_the_second_image() {
    let shot = plate();
    // 384 px 0.05 m / 0.7 m
    assert!(lost(&shot, 0..26) > 0.99);
    assert!(lost(&shot, 29..60) < 0.01);
}

#[test]
fn most_of_an_edge_is_lost_and_some_of_it_flies() {
    let shot = plate();
    let (_, last) = plate_columns(&shot);
    let at_edge = lost(&shot, last..last + 1);
    assert!((0.5..0.9).contains(&at_edge), "{at_edge}");
    let flies = |z: &&f32| (0.57..0.68).contains(*z);
    let flying = shot.image.depth_m.iter().filter(flies).count();
    assert!((1..60).contains(&flying), "{flying} of some 1100 edge pixels are in between");
}

#[test]
fn the_error_grows_with_the_distance_squared() {
    let from = |distance: f64| {
        let eye = Vector3::new(0.0, 0.0, distance);
        deviation(&errors(&looking_at(&eye, &Vector3::zeros())))
    };
    let growth = from(1.4) / from(0.7);
    assert!((3.7..4.3).contains(&growth), "{growth}");
}

#[test]
fn depths_are_whole_millimetres_and_the_same_for_a_seed() {
    let (one, other) = (plate(), plate());
    assert_eq!(one.image.depth_m, other.image.depth_m);
    let whole = |z: &f32| (z * 1000.0 - (z * 1000.0).round()).abs() < 1e-3;
    assert!(one.image.depth_m.iter().all(whole));
}

#[test]
fn the_error_at_seventy_centimetres_is_two_millimetres() {
    let camera = above(90.0);
    let errors = errors(&camera);
    let sigma = deviation(&errors);
    assert!((0.0018..0.0023).contains(&sigma), "{sigma}");
    let alike = errors.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / errors.len() as f64;
    assert!(alike > 0.5 * sigma * sigma, "neighbours err alike");
}

#[test]
fn a_grazing_table_is_not_measured() {
    let shot = capture(&[&table()], &above(8.0), &D435I, &Noise::default(), &mut generator(1, "t"));
    let middle = shot.image.depth_m[240 * 640 + 320];
    assert_eq!(middle, 0.0);
}

#[test]
fn looks_at_its_target_with_the_image_upright() {
    let camera = above(40.0);
    let target = camera.inverse() * Point3::origin();
    assert!(target.x.abs() < 1e-12 && target.y.abs() < 1e-12 && target.z > 0.0);
    let up = camera.inverse() * Point3::new(0.0, 0.0, 0.1);
    assert!(up.y < 0.0, "what is higher in the world is higher in the image");
}

#[test]
fn a_share_of_the_pixels_are_false_matches_where_that_is_asked_for() {
    let camera = above(90.0);
    let far = |outliers| {
        let noise = Noise { outliers, ..Noise::default() };
        let shot = capture(&[&table()], &camera, &D435I, &noise, &mut generator(1, "t"));
        let depths = shot.image.depth_m.iter().filter(|z| **z > 0.0);
        let truth = camera.translation.vector.z as f32;
        let wrong = depths.clone().filter(|z| (*z - truth).abs() > 0.02).count();
        wrong as f64 / depths.count() as f64
    };
    assert_eq!(far(0.0), 0.0);
    // Four of five of them are off by more than 20 of up to 100 mm.
    assert!((0.035..0.045).contains(&far(0.05)), "{}", far(0.05));
}
