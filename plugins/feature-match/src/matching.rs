//! The loss of a pose (Eq. 9 with a prior).

use crate::config::Config;
use nalgebra::{Point3, Vector3};
use seeone_core::Pose;
use seeone_plugin::{Features, PluginError, TransferTask};

/// The demonstrated features and what they are compared with.
pub(crate) struct Matching<'a> {
    task: &'a TransferTask<'a>,
    /// Z: features at H(G) on the demonstrated object (Eq. 8).
    demonstrated: Features,
    /// Spread of corresponding poses along each axis, canonical units.
    spread: Vector3<f64>,
    /// Loss of the prior at one spread.
    prior: f64,
}

impl<'a> Matching<'a> {
    /// Learns what the demonstration looked like.
    pub fn new(task: &'a TransferTask<'a>, config: &Config) -> Result<Self, PluginError> {
        let around = placed(task, task.demonstrated, task.demonstrated_scale);
        let demonstrated = task.demonstration.features(&around.collect::<Vec<_>>());
        check(&demonstrated, task.gripper_points.len())?;
        let spread = Vector3::from(config.axes().map(|axis| axis.spread));
        Ok(Self { task, demonstrated, spread, prior: config.prior })
    }

    /// The demonstrated pose moved by `offset` in canonical space.
    pub fn pose(&self, offset: &Vector3<f64>) -> Pose {
        let mut pose = *self.task.demonstrated;
        pose.translation.vector += offset;
        pose
    }

    /// The loss at each offset, by one query of the field.
    pub fn losses(&self, offsets: &[Vector3<f64>]) -> Result<Vec<f64>, PluginError> {
        let queries: Vec<Point3<f64>> = offsets
            .iter()
            .flat_map(|o| placed(self.task, &self.pose(o), self.task.instance_scale))
            .collect();
        let found = self.task.instance.features(&queries);
        check(&found, queries.len())?;
        if found.width != self.demonstrated.width {
            return Err(PluginError::Input(format!(
                "the demonstration has {} features a point, the instance {}",
                self.demonstrated.width, found.width
            )));
        }
        let losses = offsets
            .iter()
            .zip(found.values.chunks_exact(self.demonstrated.values.len()))
            .map(|(offset, values)| self.difference(values) + self.penalty(offset))
            .collect();
        Ok(losses)
    }

    /// The loss at one offset.
    pub fn loss(&self, offset: &Vector3<f64>) -> Result<f64, PluginError> {
        Ok(self.losses(std::slice::from_ref(offset))?[0])
    }

    /// Mean absolute difference from the demonstrated features.
    fn difference(&self, values: &[f32]) -> f64 {
        let apart = |(a, b): (&f32, &f32)| f64::from((a - b).abs());
        values.iter().zip(&self.demonstrated.values).map(apart).sum::<f64>() / values.len() as f64
    }

    fn penalty(&self, offset: &Vector3<f64>) -> f64 {
        self.prior * offset.component_div(&self.spread).norm_squared()
    }
}

/// The gripper's query points at `pose`, in the canonical cube of `scale` metres.
fn placed<'a>(
    task: &'a TransferTask,
    pose: &Pose,
    scale: f64,
) -> impl Iterator<Item = Point3<f64>> + use<'a> {
    let pose = *pose;
    task.gripper_points.iter().map(move |g| pose * (g / scale))
}

/// Refuses what is no answer to `rows` queries.
fn check(features: &Features, rows: usize) -> Result<(), PluginError> {
    let refuse = |cause: &str| Err(PluginError::Input(cause.to_owned()));
    if features.width == 0 || features.values.len() != rows * features.width {
        return refuse("the field answered with another number of features than was asked for");
    }
    if !features.values.iter().all(|v| v.is_finite()) {
        return refuse("the field answered with features that are not finite");
    }
    Ok(())
}
