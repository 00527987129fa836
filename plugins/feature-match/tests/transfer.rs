//! The search on fields with a closed form.

use nalgebra::{Point3, Vector3};
use seeone_feature_match::FeatureMatch;
use seeone_plugin::conformance::transfer::{Scene, SheetField};
use seeone_plugin::{
    Candidate, Features, Field, PluginError, Setup, Transfer, TransferTask, conformance,
};
use std::path::Path;

fn transfer(scene: &Scene) -> Vec<Candidate> {
    FeatureMatch::default().transfer(&scene.task()).expect("a valid task")
}

fn offset(scene: &Scene, candidate: &Candidate) -> Vector3<f64> {
    candidate.pose.translation.vector - scene.demonstrated.translation.vector
}

/// The scene with nothing seen near the gripper.
fn hidden(rise: f64) -> Scene {
    let mut scene = Scene::with_rise(rise);
    scene.cloud.nocs.iter_mut().for_each(|p| p.y -= 0.6);
    scene
}

fn configured(table: &str) -> Result<FeatureMatch, PluginError> {
    let config = table.parse().expect("TOML");
    FeatureMatch::from_setup(&Setup {
        config: &config,
        root: Path::new("."),
        seed: 0,
        world: None,
        robot: None,
    })
}

#[test]
fn conforms() {
    conformance::transfer(&FeatureMatch::default()).expect("conforms");
}

#[test]
fn the_search_alone_finds_the_rise() {
    for rise in [-0.08, -0.033, 0.0, 0.05, 0.09] {
        let scene = hidden(rise);
        let found = transfer(&scene);
        let error = offset(&scene, &found[0]) - Vector3::new(0.0, 0.0, rise);
        // The gripper is a tenth smaller on the larger instance: not to the last digit.
        assert!(error.norm() < 0.006, "rise {rise}: {error:?}");
        assert_eq!(found[0].origin, "feature match");
        assert_eq!(found.last().expect("not empty").pose, scene.demonstrated);
    }
}

#[test]
fn the_snap_lands_on_the_sheet() {
    let scene = Scene::with_rise(0.053);
    let found = transfer(&scene);
    assert!((offset(&scene, &found[0]).z - 0.053).abs() < 1e-9, "{found:?}");
    assert!(found[0].origin.contains("snapped"), "{found:?}");
    assert_eq!(found[0].pose.rotation, scene.demonstrated.rotation);
    assert!(found[0].confidence > found[1].confidence, "{found:?}");
}

#[test]
fn a_flat_field_leaves_the_prior() {
    let mut scene = hidden(0.06);
    scene.demonstration.contrast = 0.0;
    scene.instance.contrast = 0.0;
    let found = transfer(&scene);
    assert!(offset(&scene, &found[0]).norm() < 1e-9, "{found:?}");
    assert!(found[0].confidence < 0.1, "{found:?}");
    assert!(transfer(&hidden(0.06))[0].confidence > found[0].confidence);
}

/// A sheet and its echo: features that come again at another height.
struct Echo(SheetField);

impl Field for Echo {
    fn features(&self, queries: &[Point3<f64>]) -> Features {
        let folded: Vec<_> = queries
            .iter()
            .map(|p| {
                let z = p.z - self.0.height;
                Point3::new(p.x, p.y, self.0.height + if z > 0.06 { z - 0.12 } else { z })
            })
            .collect();
        self.0.features(&folded)
    }

    fn winding(&self, _queries: &[Point3<f64>]) -> Option<Vec<f64>> {
        None
    }
}

#[test]
fn a_second_minimum_is_offered_too() {
    let scene = hidden(-0.06);
    let echo = Echo(scene.instance);
    let task = TransferTask { instance: &echo, ..scene.task() };
    let plugin = configured("temperature = 0.001").expect("valid");
    let found = plugin.transfer(&task).expect("a valid task");
    let other = found.iter().find(|c| c.origin == "another minimum").expect("offered");
    let heights = [&found[0], other].map(|c| offset(&scene, c).z);
    assert!((heights[0].abs() - 0.06).abs() < 0.01, "not on the ridge between: {found:?}");
    assert!((heights[1] + heights[0]).abs() < 0.021, "{found:?}");
}

struct Answer(Features);

impl Field for Answer {
    fn features(&self, _queries: &[Point3<f64>]) -> Features {
        self.0.clone()
    }

    fn winding(&self, _queries: &[Point3<f64>]) -> Option<Vec<f64>> {
        None
    }
}

#[test]
fn fields_that_answer_wrongly_are_refused() {
    let scene = Scene::with_rise(0.0);
    let rows = scene.gripper_points.len() * 39;
    let refusal = |width: usize, value: f32, rows: usize| {
        let field = Answer(Features { width, values: vec![value; rows * width] });
        let task = TransferTask { instance: &field, ..scene.task() };
        match FeatureMatch::default().transfer(&task) {
            Err(PluginError::Input(told)) => told,
            other => panic!("not refused: {other:?}"),
        }
    };
    assert!(refusal(2, 0.1, rows).contains("the instance 2"));
    assert!(refusal(3, f32::NAN, rows).contains("not finite"));
    assert!(refusal(3, 0.1, rows - 1).contains("another number"));
}

#[test]
fn wrong_tables_are_refused() {
    for table in [
        "temperature = 0.0",
        "prior = nan",
        "lambda = 0.1",
        "z = { steps = 12, reach = 0.1 }",
        "z = { steps = 5, reach = 0.0 }",
        "y = { reach = -0.1, steps = 3 }",
        "x = { spread = inf }",
        "snap_points = 0",
        "x = { reach = 0.1, steps = 19999 }",
    ] {
        let told = configured(table);
        assert!(matches!(told, Err(PluginError::Configuration(_))), "{table}: {told:?}");
    }
    configured("x = { reach = 0.02, steps = 3 }").expect("a wider grid is allowed");
}
