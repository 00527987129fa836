//! Truth in the place of what a robot finds out, to learn what each step costs. For evaluations
//! alone: no run of a skill may ask it.

use crate::simulated::SimulatedCell;
use crate::verbs::teach;
use anyhow::{Context, Result};
use clap::ValueEnum;
use nalgebra::{Point3, Translation3, Vector3};
use seeone_core::formats::ply;
use seeone_core::{Cloud, Pose};
use seeone_nn::sampling::three_nearest;
use seeone_plugin::{
    Candidate, CanonicalCloud, Observation, Perception, PluginError, Transfer, TransferTask,
};
use seeone_runtime::files::Skill;
use seeone_runtime::plugins::Plugins;
use seeone_sim::cell::Cell;
use serde::Serialize;
use std::sync::{Arc, Mutex};

/// What is told by the simulated cell instead of found out.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Oracle {
    /// The canonical coordinates of what is seen of the object. The demonstration is perceived.
    Coordinates,
    /// The grasp in canonical space: that of `teach`'s expert.
    Grasp,
}

/// Puts `oracles` into the places of `plugins`.
///
/// # Errors
/// When a cloud of the skill cannot be read, the cell has no head, so that no canonical state is
/// known, or the expert knows no grasp of the object.
pub fn consult(
    oracles: &[Oracle],
    plugins: Plugins,
    cell: &SimulatedCell,
    skill: &Skill,
) -> Result<Plugins> {
    if oracles.is_empty() {
        return Ok(plugins);
    }
    let mut plugins = plugins;
    let worn = cell.worn().context("an oracle needs a scene with a head")?;
    if oracles.contains(&Oracle::Coordinates) {
        let result = skill.result.iter().map(|result| &result.cloud);
        let shown = [&skill.demonstration.cloud]
            .into_iter()
            .chain(result)
            .map(|path| ply::read_cloud(path));
        plugins.perception = Box::new(TrueCoordinates {
            inner: plugins.perception,
            shown: shown.collect::<Result<_, _>>()?,
            cell: Arc::clone(&cell.cell),
            canonical: worn.canonical.vertices.iter().map(|v| Point3::from(*v)).collect(),
        });
    }
    if oracles.contains(&Oracle::Grasp) {
        let to_cube = worn.canonical_to_head.inverse();
        let (expert, _) = teach::grasp(cell)?;
        let tool = expert.tool_on(&worn.vertices);
        let place = to_cube * Point3::from(tool.translation.vector);
        let rotation = to_cube.isometry.rotation * tool.rotation;
        let pose = Pose::from_parts(Translation3::from(place.coords), rotation);
        plugins.transfer = Box::new(TrueGrasp(pose));
    }
    Ok(plugins)
}

/// Points as the perception samples them, with the coordinates that they truly have: those of the
/// three nearest vertices, mixed.
struct TrueCoordinates {
    inner: Box<dyn Perception>,
    /// The clouds of the skill, whose truth nobody knows here.
    shown: Vec<Cloud>,
    cell: Arc<Mutex<Cell>>,
    canonical: Vec<Point3<f64>>,
}

impl Perception for TrueCoordinates {
    fn perceive(&mut self, observation: &Observation) -> Result<CanonicalCloud, PluginError> {
        let mut cloud = self.inner.perceive(observation)?;
        if self.shown.contains(&observation.cloud) {
            return Ok(cloud);
        }
        let cell = self.cell.lock();
        let cell = cell.map_err(|_| PluginError::Internal("the simulated cell broke".into()))?;
        let single = |points: &[Point3<f64>]| -> Vec<[f32; 3]> {
            points.iter().map(|p| p.coords.map(|c| c as f32).into()).collect()
        };
        let found = three_nearest(&single(&cloud.points), &single(cell.vertices()));
        let mixed = found.rows.iter().zip(&found.weights).map(|(rows, weights)| {
            let parts = rows.iter().zip(weights);
            Point3::from(
                parts
                    .map(|(row, weight)| self.canonical[*row as usize].coords * f64::from(*weight))
                    .sum::<Vector3<f64>>(),
            )
        });
        cloud.nocs = mixed.collect();
        cloud.confidence.fill([1.0; 3]);
        Ok(cloud)
    }
}

/// The one grasp that the expert has in canonical space.
struct TrueGrasp(Pose);

impl Transfer for TrueGrasp {
    fn transfer(&self, _: &TransferTask) -> Result<Vec<Candidate>, PluginError> {
        Ok(vec![Candidate {
            pose: self.0,
            loss: 0.0,
            confidence: 1.0,
            lay_on_surface: true,
            origin: "the expert's".into(),
        }])
    }
}
