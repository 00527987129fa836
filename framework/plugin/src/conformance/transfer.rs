//! The rules of kind `transfer`.

use super::violation::{Violation, answered, answered_or_refused, hold, refused, sound};
use crate::transfer::check_candidates;
use crate::{Candidate, CanonicalCloud, Features, Field, PluginError, Transfer, TransferTask};
use nalgebra::{Point3, Vector3};
use seeone_core::Pose;
use seeone_core::pose::rotation_from_approach;

/// A field with a closed form: the features round a sheet at constant height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SheetField {
    /// Canonical z of the sheet.
    pub height: f64,
    /// How strongly the features change with the distance from the sheet; zero for a
    /// field that is the same everywhere.
    pub contrast: f64,
}

/// Distance from the sheet over which the features change, canonical units.
const FALL_OFF: f64 = 0.05;

impl Field for SheetField {
    fn features(&self, queries: &[Point3<f64>]) -> Features {
        let values = queries
            .iter()
            .flat_map(|p| {
                let distance = (p.z - self.height) / FALL_OFF;
                let side = self.contrast * distance.tanh();
                let closeness = self.contrast * (-0.5 * distance * distance).exp();
                [side as f32, closeness as f32, 0.3]
            })
            .collect();
        Features { width: 3, values }
    }

    fn winding(&self, _queries: &[Point3<f64>]) -> Option<Vec<f64>> {
        None
    }
}

/// A transfer task whose answer is known: a sheet of the instance at another height than
/// the demonstrated one, which was grasped from the front.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The demonstrated gripper pose, canonical; its origin lies on the demonstrated sheet.
    pub demonstrated: Pose,
    /// The demonstrated field.
    pub demonstration: SheetField,
    /// The instance's field.
    pub instance: SheetField,
    /// Points seen of the instance's sheet.
    pub cloud: CanonicalCloud,
    /// Query points round the gripper, tool frame, metres.
    pub gripper_points: Vec<Point3<f64>>,
}

/// Metres per canonical unit of the scene's demonstrated object and of its instance.
const SCALES: [f64; 2] = [0.26, 0.29];

impl Scene {
    /// A scene whose instance carries its sheet `rise` higher than the demonstrated object.
    pub fn with_rise(rise: f64) -> Self {
        let height = 0.3;
        let square = |n: usize, step: f64| {
            (0..n * n).map(move |i| (step * (i % n) as f64, step * (i / n) as f64))
        };
        let nocs: Vec<_> =
            square(15, 0.02).map(|(x, y)| Point3::new(0.36 + x, 0.7 + y, height + rise)).collect();
        let gripper_points = square(6, 0.006)
            .flat_map(|(y, z)| [-0.01, 0.01].map(|x| Point3::new(x, y - 0.015, z - 0.02)))
            .collect();
        Self {
            demonstrated: Pose::from_parts(
                Vector3::new(0.5, 0.9, height).into(),
                rotation_from_approach(&-Vector3::y(), &Vector3::z()),
            ),
            demonstration: SheetField { height, contrast: 1.0 },
            instance: SheetField { height: height + rise, contrast: 1.0 },
            cloud: CanonicalCloud {
                points: nocs.iter().map(|p| p * SCALES[1]).collect(),
                confidence: vec![[0.9; 3]; nocs.len()],
                nocs,
                features: Vec::new(),
                feature_width: 0,
            },
            gripper_points,
        }
    }

    /// The scene as a task.
    pub fn task(&self) -> TransferTask<'_> {
        TransferTask {
            demonstrated: &self.demonstrated,
            demonstrated_scale: SCALES[0],
            demonstration: &self.demonstration,
            instance: &self.instance,
            cloud: &self.cloud,
            instance_scale: SCALES[1],
            gripper_points: &self.gripper_points,
        }
    }
}

/// Holds every rule of the kind.
///
/// # Errors
/// The first rule that `plugin` breaks.
pub fn transfer(plugin: &dyn Transfer) -> Result<(), Violation> {
    let rule = "finite in, finite and within its range out";
    let scene = Scene::with_rise(0.04);
    let found = answered(rule, || plugin.transfer(&scene.task()))?;
    hold("there is always a candidate", !found.is_empty(), || "none".into())?;
    sound(rule, check_candidates(&found))?;

    let rule = "the same input gives the same bytes";
    let again = answered(rule, || plugin.transfer(&scene.task()))?;
    hold(rule, format!("{found:?}") == format!("{again:?}"), || format!("{found:?} / {again:?}"))?;

    let rule = "the demonstrated pose on the demonstrated object is kept";
    let same = answered(rule, || plugin.transfer(&Scene::with_rise(0.0).task()))?;
    let moved = (same[0].pose.translation.vector - scene.demonstrated.translation.vector).norm();
    hold(rule, moved < 0.01, || format!("moved by {moved:.4} of the cube"))?;

    refuses_what_is_wrong(plugin)
}

fn refuses_what_is_wrong(plugin: &dyn Transfer) -> Result<(), Violation> {
    let broken = |spoil: &dyn Fn(&mut Scene)| -> Result<Vec<Candidate>, PluginError> {
        let mut scene = Scene::with_rise(0.0);
        spoil(&mut scene);
        plugin.transfer(&scene.task())
    };
    answered_or_refused(
        "a cloud of one point is answered or refused",
        || {
            broken(&|s| {
                s.cloud.points.truncate(1);
                s.cloud.nocs.truncate(1);
                s.cloud.confidence.truncate(1);
            })
        },
        |found| check_candidates(found),
    )?;
    refused("an empty cloud is refused", || broken(&|s| s.cloud = CanonicalCloud::default()))?;
    refused("a cloud without coordinates is refused", || broken(&|s| s.cloud.nocs.clear()))?;
    refused("a NaN coordinate is refused", || broken(&|s| s.cloud.nocs[3].x = f64::NAN))?;
    refused("a NaN confidence is refused", || broken(&|s| s.cloud.confidence[3][1] = f64::NAN))?;
    refused("a NaN pose is refused", || broken(&|s| s.demonstrated.translation.x = f64::NAN))?;
    refused("a NaN gripper point is refused", || broken(&|s| s.gripper_points[0].z = f64::NAN))?;
    refused("a gripper without points is refused", || broken(&|s| s.gripper_points.clear()))?;
    let scene = Scene::with_rise(0.0);
    for scale in [0.0, -0.2, f64::NAN] {
        let rule = "a scale that is not positive is refused";
        let task = TransferTask { instance_scale: scale, ..scene.task() };
        refused(rule, || plugin.transfer(&task))?;
        let task = TransferTask { demonstrated_scale: scale, ..scene.task() };
        refused(rule, || plugin.transfer(&task))?;
    }
    Ok(())
}
