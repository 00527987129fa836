//! What an evaluation makes worse than the files say, to find what a skill bears.

use clap::Args;
use nalgebra::{Translation3, UnitQuaternion, Vector3};
use seeone_core::Pose;
use seeone_core::random::{generator, uniform};
use seeone_runtime::files::{Scene, Targets};
use serde::Serialize;

/// What is made worse; nothing by default.
#[derive(Clone, Copy, Debug, PartialEq, Args, Serialize)]
pub struct Disturbance {
    /// Each attempt finds the head up to so many metres from where the scene has it, along x and
    /// along y.
    #[arg(long, value_name = "METRES", default_value_t = 0.0, value_parser = metres)]
    pub head_moves: f64,
    /// And turned about its up axis by up to so many degrees.
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, value_parser = degrees)]
    pub head_turns: f64,
    /// The camera's axial error in multiples of a real one's; for `camera-sim`.
    #[arg(long, value_name = "TIMES", default_value_t = 1.0, value_parser = times)]
    pub camera_noise: f64,
    /// Share of the pixels whose depth is wrong by up to 100 mm; for `camera-sim`.
    #[arg(long, value_name = "SHARE", default_value_t = 0.0, value_parser = share)]
    pub outliers: f64,
}

/// The farthest that a head may stand from its place, metres.
const FARTHEST_M: f64 = 1.0;
/// The most noise of a sensor that is one.
const NOISIEST: f64 = 100.0;

fn within(text: &str, most: f64) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| (0.0..=most).contains(number));
    number.ok_or_else(|| format!("it must be a number from 0 to {most}"))
}

fn metres(text: &str) -> Result<f64, String> {
    within(text, FARTHEST_M)
}

fn degrees(text: &str) -> Result<f64, String> {
    within(text, 180.0)
}

fn times(text: &str) -> Result<f64, String> {
    within(text, NOISIEST)
}

fn share(text: &str) -> Result<f64, String> {
    within(text, 1.0)
}

impl Disturbance {
    /// The scene as the attempt of `seed` finds it.
    pub fn scene(&self, scene: &Scene, seed: u64) -> Scene {
        let mut scene = scene.clone();
        let mut random = generator(seed, "disturbance");
        let mut drawn = |most: f64| uniform(&mut random, -most, most);
        let moved = Translation3::new(drawn(self.head_moves), drawn(self.head_moves), 0.0);
        let turned = drawn(self.head_turns.to_radians());
        let turned = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turned);
        if let Targets::Head(head) | Targets::Both(head, _) = &mut scene.targets {
            head.pose =
                Pose::from_parts(moved * head.pose.translation, turned * head.pose.rotation);
        }
        scene
    }

    /// Writes into the camera's table what it must know.
    pub fn camera(&self, table: &mut toml::Table) {
        let noise = toml::Table::from_iter([
            ("times".to_owned(), self.camera_noise.into()),
            ("outliers".to_owned(), self.outliers.into()),
        ]);
        if (self.camera_noise, self.outliers) != (1.0, 0.0) {
            table.insert("noise".into(), noise.into());
        }
    }
}

impl Default for Disturbance {
    fn default() -> Self {
        Self { head_moves: 0.0, head_turns: 0.0, camera_noise: 1.0, outliers: 0.0 }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use seeone_core::pose::difference;
    use seeone_runtime::files::KnownMethods;
    use std::path::Path;

    #[test]
    fn a_seed_moves_the_head_within_its_bounds_and_nothing_else() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/head.toml");
        let scene = Scene::read(&path, &KnownMethods::new()).unwrap();
        let (still, at) = (Disturbance::default(), |scene: &Scene| scene.head().unwrap().pose);
        assert_eq!(still.scene(&scene, 3), scene);
        let moves = Disturbance { head_moves: 0.15, head_turns: 30.0, ..still };
        for seed in 0..20 {
            let moved = moves.scene(&scene, seed);
            let (metres, radians) = difference(&at(&moved), &at(&scene));
            assert!(metres > 1e-3 && metres < 0.15 * 2f64.sqrt() && radians < 30f64.to_radians());
            assert_eq!(moves.scene(&scene, seed), moved);
            assert_eq!((&moved.drop, &moved.camera), (&scene.drop, &scene.camera));
        }
    }

    #[test]
    fn only_a_noisy_camera_is_told_so() {
        let mut table = toml::Table::new();
        Disturbance::default().camera(&mut table);
        assert!(table.is_empty());
        Disturbance { outliers: 0.05, ..Disturbance::default() }.camera(&mut table);
        assert_eq!(table["noise"]["outliers"].as_float(), Some(0.05));
    }

    #[test]
    fn what_is_no_number_or_too_much_is_refused() {
        assert!(["x", "nan", "-0.1", "1.1"].iter().all(|text| share(text).is_err()));
        assert_eq!((share("0.05"), degrees("180")), (Ok(0.05), Ok(180.0)));
    }
}
