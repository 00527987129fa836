//! Training of the encoding on what a frozen perception makes of the training set.

use crate::GraspSpread;
use crate::NseError;
use crate::encoding::{NETWORK_NAME, Nse, WEIGHTS_NAME, requirements};
use crate::lesson::Lessons;
use crate::perceived::{Perceive, Progress, canonical_meshes, perceived};
use seeone_core::Diagnostic;
use seeone_core::frames::{Frame, read_all};
use seeone_nn::train::Ending;
use seeone_nn::weights::Precision;
use seeone_nn::{Card, Parameters, Plan, train as trainer, weights};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Name of the file from which an interrupted training continues.
const CHECKPOINT_NAME: &str = "nse.checkpoint";
/// Samples a step: two on each of the trainer's two threads.
const BATCH: u64 = 4;
/// Learning rate of the flat part of the schedule.
const PEAK_RATE: f64 = 2e-3;
/// Samples between two checkpoints: about a minute of work.
const CHECKPOINT_EVERY: u64 = 512;

/// What to train on, and how long.
#[derive(Clone, Debug, PartialEq)]
pub struct TrainPlan {
    /// Folder of the training set.
    pub data: PathBuf,
    /// Folder of the perception's weights; its card's hashes go into this encoding's.
    pub perception: PathBuf,
    /// Folder for the weights and their card; the checkpoint lies there meanwhile.
    pub out: PathBuf,
    /// Seed of the initial weights and of every draw.
    pub seed: u64,
    /// Samples in all.
    pub samples: u64,
    /// Frames of objects at rest to learn from, at most, spread evenly over the set.
    pub frames: usize,
    /// The command that the card shall name.
    pub command: String,
}

/// Trains, and writes weights and card into the plan's folder. Frames that the perception
/// refuses are left out. Interrupted by `progress`, it leaves a checkpoint from which the
/// same plan continues.
///
/// # Errors
/// [`NseError::Data`] when nothing can be learnt from the set, [`NseError::File`] and
/// [`NseError::Training`].
pub fn train(
    plan: &TrainPlan,
    perceive: Perceive,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<Ending, NseError> {
    let perception = Card::read(&plan.perception)?;
    let (index, frames) = read_all(&plan.data)?;
    let settled: Vec<Frame> = frames.into_iter().filter(|f| f.info.at_rest()).collect();
    let stride = settled.len().div_ceil(plan.frames.max(1)).max(1);
    let chosen: Vec<&Frame> = settled.iter().step_by(stride).collect();
    let Some(lessons) = perceived(&chosen, perceive, progress)? else {
        return Ok(Ending::Interrupted);
    };
    let meshes = canonical_meshes(&index)?;
    let lessons = Lessons::new(lessons, &meshes, plan.seed)?;
    std::fs::create_dir_all(&plan.out).map_err(|e| unwritable(&plan.out, &e))?;
    let mut parameters = Parameters::new(plan.seed);
    let nse = Nse::new(&mut parameters, lessons.columns())?;
    let requires = requirements(&perception);
    let ending = fit(&nse, &parameters, &lessons, plan, &requires, progress)?;
    if ending == Ending::Finished {
        let figures = GraspSpread::of(&meshes).into_iter().flat_map(|spread| {
            [("grasp_spread_y_cube", spread.y), ("grasp_spread_z_cube", spread.z)]
        });
        let card = Card {
            schema: 1,
            network: NETWORK_NAME.into(),
            category: perception.category,
            data_seed: index.seed,
            seed: plan.seed,
            command: plan.command.clone(),
            samples: BTreeMap::from([(NETWORK_NAME.into(), plan.samples)]),
            requires,
            figures: figures.map(|(name, value)| (name.into(), value)).collect(),
            weights: vec![weights::save(
                &plan.out.join(WEIGHTS_NAME),
                &parameters,
                Precision::Half,
            )?],
        };
        card.write(&plan.out)?;
        let checkpoint = plan.out.join(CHECKPOINT_NAME);
        std::fs::remove_file(&checkpoint).map_err(|e| unwritable(&checkpoint, &e))?;
    }
    Ok(ending)
}

fn unwritable(path: &Path, cause: &std::io::Error) -> Diagnostic {
    Diagnostic::new("W004", cause.to_string()).in_file(path)
}

/// Minimises Eq. 5 over the lessons.
fn fit(
    nse: &Nse,
    parameters: &Parameters,
    lessons: &Lessons,
    plan: &TrainPlan,
    requires: &BTreeMap<String, String>,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<Ending, NseError> {
    let label = format!("nse {} {} {requires:?}", plan.seed, plan.data.display());
    let schedule = Plan {
        label,
        samples: plan.samples,
        batch: BATCH,
        peak_rate: PEAK_RATE,
        checkpoint_every: CHECKPOINT_EVERY,
    };
    Ok(trainer::train(
        parameters,
        &schedule,
        Some(&plan.out.join(CHECKPOINT_NAME)),
        &|samples| lessons.loss(nse.network(), samples),
        &mut |p| progress(Progress::Training(p)),
    )?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_caps::cap;
    use crate::test_clouds::{cloud, growth};
    use crate::{evaluate, record};
    use seeone_core::Pose;
    use seeone_core::frames::{
        CanonicalObject, FrameInfo, Index, Moment, SCHEMA, write_index, write_shard,
    };
    use seeone_plugin::{CanonicalCloud, PluginError};

    /// A training set of one frame of each of eight caps, and the card of a perception.
    fn set(folder: &Path) {
        let info = |object| FrameInfo {
            object,
            drop: 0,
            seconds: 1.0,
            moment: Moment::Resting,
            camera: (&Pose::translation(0.0, -0.5, 0.5)).into(),
            object_pose: (&Pose::identity()).into(),
        };
        let objects = (0..8).map(|i| {
            let mesh = cap(growth(i));
            CanonicalObject {
                name: format!("cap-{i}"),
                vertices: mesh.vertices().iter().map(|v| [v.x, v.y, v.z]).collect(),
                triangles: mesh.triangles().to_vec(),
                edge_m: 0.28,
                round: false,
            }
        });
        let infos: Vec<FrameInfo> = (0..8).map(info).collect();
        let frames: Vec<Frame> = infos
            .iter()
            .map(|info| Frame {
                info: info.clone(),
                points: vec![[0.0; 3]; 4],
                nocs: vec![[0.5; 3]; 4],
            })
            .collect();
        write_shard(folder, 0, &frames).expect("a shard");
        let (objects, command) = (objects.collect(), "test".to_owned());
        write_index(
            folder,
            &Index { schema: SCHEMA, seed: 1, command, objects, shards: vec![infos] },
        )
        .expect("an index");
        perception_card(folder, "a");
    }

    fn perception_card(folder: &Path, hash: &str) {
        let weights = vec![seeone_nn::WeightsEntry {
            file: "refiner.safetensors".into(),
            blake3: hash.into(),
            tensors: vec![],
        }];
        let card = Card {
            schema: 1,
            network: "test".into(),
            category: "cap".into(),
            data_seed: 1,
            seed: 1,
            command: "test".into(),
            samples: BTreeMap::new(),
            requires: BTreeMap::new(),
            figures: BTreeMap::new(),
            weights,
        };
        card.write(folder).expect("a card");
    }

    fn perceive(frame: &Frame) -> Result<CanonicalCloud, PluginError> {
        Ok(cloud(frame.info.object, 500))
    }

    #[test]
    fn learns_the_shape_and_its_weights_work_with_their_own_perception_only() {
        let folder = tempfile::tempdir().expect("a folder");
        set(folder.path());
        let out = folder.path().join("weights");
        let plan = TrainPlan {
            data: folder.path().into(),
            perception: folder.path().into(),
            out: out.clone(),
            seed: 1,
            samples: 120,
            frames: 100,
            command: "test".into(),
        };
        let ending = train(&plan, &perceive, &mut |_| ControlFlow::Continue(())).expect("trained");
        assert_eq!(ending, Ending::Finished);

        let nse = Nse::load(&out, folder.path()).expect("loaded");
        let figures = evaluate(&nse, folder.path(), &perceive, &mut |_| ControlFlow::Continue(()))
            .expect("measured")
            .expect("figures");
        record(&out, "train", &figures).expect("recorded");
        let card = Card::read(&out).expect("a card");
        assert_eq!(card.figures["winding_error_train"], figures.winding_error);
        assert!(card.figures["grasp_spread_z_cube"] > 0.02);
        assert_eq!(figures.frames, 8);
        assert!(figures.winding_error < 0.85 * figures.constant_error, "{figures:?}");

        let other = folder.path().join("other");
        std::fs::create_dir(&other).expect("a folder");
        perception_card(&other, "b");
        assert!(matches!(Nse::load(&out, &other), Err(NseError::File(_))));
    }
}
