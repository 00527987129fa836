//! Both alignments on pairs whose similarity is known.

use nalgebra::{Point3, UnitQuaternion, Vector3};
use seeone_core::Similarity;
use seeone_core::random::{Generator, generator, normal, uniform};
use seeone_plugin::{Alignment, Correspondences, PluginError, Setup, conformance};
use seeone_procrustes::{Procrustes, Ransac};
use std::path::Path;

fn setup(config: &toml::Table) -> Setup<'_> {
    Setup { config, root: Path::new("."), seed: 7, world: None, robot: None }
}

fn procrustes() -> Procrustes {
    Procrustes::default()
}

fn ransac() -> Ransac {
    Ransac::from_setup(&setup(&toml::Table::new())).expect("defaults are valid")
}

/// The canonical cube -> metres, as for a cap on a table.
fn truth() -> Similarity {
    let rotation = UnitQuaternion::from_euler_angles(0.4, -1.2, 2.6);
    Similarity::from_parts(Vector3::new(0.45, -0.2, 0.05).into(), rotation, 0.26)
}

fn in_cube(rng: &mut Generator) -> Point3<f64> {
    Point3::new(uniform(rng, 0.0, 1.0), uniform(rng, 0.0, 1.0), uniform(rng, 0.0, 1.0))
}

/// Points of the unit cube and where the truth carries them, with normal noise of
/// `noise_m`; the first `wrong` share is carried somewhere else in the same cube.
fn pairs(noise_m: f64, wrong: f64) -> (Vec<Point3<f64>>, Vec<Point3<f64>>) {
    let mut rng = generator(3, "pairs");
    let source: Vec<_> = (0..400).map(|_| in_cube(&mut rng)).collect();
    let target = source
        .iter()
        .enumerate()
        .map(|(i, p)| {
            let p = if (i as f64) < wrong * 400.0 { in_cube(&mut rng) } else { *p };
            let noise = Vector3::from_fn(|_, _| noise_m * normal(&mut rng));
            truth() * p + noise
        })
        .collect();
    (source, target)
}

fn align(
    plugin: &dyn Alignment,
    (source, target): &(Vec<Point3<f64>>, Vec<Point3<f64>>),
    fixed_scale: Option<f64>,
) -> Result<seeone_plugin::AlignmentOutcome, PluginError> {
    let weights = vec![1.0; source.len()];
    plugin.align(&Correspondences { source, target, weights: &weights, fixed_scale })
}

/// Largest distance in metres by which `found` misplaces a corner of the cube.
fn error_m(found: &Similarity) -> f64 {
    (0..8u8)
        .map(|i| Point3::from([i & 1, i >> 1 & 1, i >> 2].map(f64::from)))
        .map(|corner| (found * corner - truth() * corner).norm())
        .fold(0.0, f64::max)
}

#[test]
fn both_conform() {
    conformance::alignment(&procrustes()).expect("procrustes conforms");
    conformance::alignment(&ransac()).expect("ransac conforms");
}

#[test]
fn noise_is_averaged_out_and_reported() {
    let found = align(&procrustes(), &pairs(0.005, 0.0), None).expect("solvable");
    assert!(error_m(&found.transform) < 0.002, "{}", error_m(&found.transform));
    assert!((found.residual - 0.005 * 3f64.sqrt()).abs() < 0.001, "{found:?}");
    assert!(found.inlier_share > 0.97, "{found:?}");
}

#[test]
fn a_third_of_wrong_pairs_does_no_harm() {
    for plugin in [&procrustes() as &dyn Alignment, &ransac()] {
        let found = align(plugin, &pairs(0.003, 0.3), None).expect("solvable");
        assert!(error_m(&found.transform) < 0.002, "{}", error_m(&found.transform));
        assert!((0.66..0.76).contains(&found.inlier_share), "{found:?}");
    }
}

#[test]
fn plain_least_squares_is_harmed_by_them() {
    let config = "reweightings = 0".parse().expect("TOML");
    let plain = Procrustes::from_setup(&setup(&config)).expect("valid");
    let found = align(&plain, &pairs(0.003, 0.3), None).expect("solvable");
    assert!(error_m(&found.transform) > 0.02, "{}", error_m(&found.transform));
}

#[test]
fn ransac_survives_a_majority_of_wrong_pairs() {
    let found = align(&ransac(), &pairs(0.003, 0.65), None).expect("solvable");
    assert!(error_m(&found.transform) < 0.004, "{}", error_m(&found.transform));
}

#[test]
fn a_planar_patch_is_enough() {
    let (mut source, _) = pairs(0.0, 0.0);
    source.iter_mut().for_each(|p| p.z = 0.3);
    let target = source.iter().map(|p| truth() * p).collect();
    let patch = (source, target);
    for plugin in [&procrustes() as &dyn Alignment, &ransac()] {
        let found = align(plugin, &patch, Some(0.26)).expect("solvable");
        assert!(error_m(&found.transform) < 1e-9, "{}", error_m(&found.transform));
        assert!(found.condition > 0.5, "{found:?}");
    }
}

#[test]
fn a_line_is_refused_and_a_narrow_strip_is_told_by_its_condition() {
    let (mut source, _) = pairs(0.0, 0.0);
    source.iter_mut().for_each(|p| (p.y, p.z) = (0.05 * p.y, 0.3));
    let strip = (source.clone(), source.iter().map(|p| truth() * p).collect());
    let found = align(&procrustes(), &strip, None).expect("solvable");
    assert!(found.condition < 0.01, "{found:?}");
    source.iter_mut().for_each(|p| p.y = 0.3);
    let line = (source.clone(), source.iter().map(|p| truth() * p).collect());
    for plugin in [&procrustes() as &dyn Alignment, &ransac()] {
        let told = align(plugin, &line, None).expect_err("not determined").to_string();
        assert!(told.contains("one line"), "{told}");
    }
}

#[test]
fn a_mirror_image_is_never_answered_with_a_reflection() {
    let (source, mut target) = pairs(0.0, 0.0);
    target.iter_mut().zip(&source).for_each(|(q, p)| *q = Point3::new(-p.x, p.y, p.z));
    let found = align(&procrustes(), &(source, target), None).expect("solvable");
    let rotation = found.transform.isometry.rotation.to_rotation_matrix();
    assert!((rotation.matrix().determinant() - 1.0).abs() < 1e-12);
    assert!(found.residual > 0.1, "{found:?}");
}

#[test]
fn weights_choose_between_two_stories() {
    let (source, mut target) = pairs(0.0, 0.0);
    target[..240].iter_mut().for_each(|q| q.x += 0.1);
    let weights: Vec<f64> = (0..400).map(|i| if i < 240 { 0.01 } else { 1.0 }).collect();
    let pairs =
        Correspondences { source: &source, target: &target, weights: &weights, fixed_scale: None };
    let found = procrustes().align(&pairs).expect("solvable");
    assert!(error_m(&found.transform) < 1e-4, "{}", error_m(&found.transform));
}

#[test]
fn wrong_tables_are_refused() {
    for table in ["spede = 1", "tuning = -1.0", "tuning = nan", "reweightings = -3"] {
        let config = table.parse().expect("TOML");
        let told = Procrustes::from_setup(&setup(&config));
        assert!(matches!(told, Err(PluginError::Configuration(_))), "{table}: {told:?}");
    }
    for table in ["hypotheses = 0", "threshold = inf", "tuning = 0.0", "reweight = 2"] {
        let config = table.parse().expect("TOML");
        let told = Ransac::from_setup(&setup(&config));
        assert!(matches!(told, Err(PluginError::Configuration(_))), "{table}: {told:?}");
    }
}
