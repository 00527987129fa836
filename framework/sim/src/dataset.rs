//! Training sets: drops of many objects, seen by the depth camera, every point with its
//! canonical coordinates.

mod shard;
mod view;

use crate::object::Object;
use crate::world::Settings;
use crate::worn::{WornFault, worn};
use rayon::prelude::*;
use seeone_core::Diagnostic;
use seeone_core::frames::{self, Index};
use shard::Shard;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What to generate.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The objects, one shard each.
    pub objects: Vec<Object>,
    /// Drops of each object.
    pub drops_per_object: usize,
    /// Views of each moment that is kept.
    pub views: usize,
    /// Seed of every draw.
    pub seed: u64,
    /// The command that the index shall name.
    pub command: String,
}

/// How far a generation has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Objects done.
    pub done: usize,
    /// Objects in all.
    pub total: usize,
}

/// What was generated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Summary {
    /// Frames in the set.
    pub frames: usize,
    /// Frames that show an object at rest.
    pub settled: usize,
    /// Objects that were found done and not made again.
    pub resumed: usize,
}

/// Generates the set into `folder`, which must exist. A shard that is there already, whole
/// and of the same plan, is kept, so that an interrupted generation goes on where it
/// stopped. The bytes do not depend on the number of threads.
///
/// # Errors
/// `D001` when a file cannot be written, `D010` when an object has no worn state.
pub fn generate(
    plan: &Plan,
    folder: &Path,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Summary, Diagnostic> {
    let total = plan.objects.len();
    let (done, resumed) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let shards: Vec<Shard> = plan
        .objects
        .par_iter()
        .enumerate()
        .map(|(number, object)| {
            let shard = match Shard::found(plan, folder, number) {
                Some(shard) => {
                    resumed.fetch_add(1, Ordering::Relaxed);
                    shard
                }
                None => make(plan, folder, number, object)?,
            };
            progress(Progress { done: done.fetch_add(1, Ordering::Relaxed) + 1, total });
            Ok(shard)
        })
        .collect::<Result<_, Diagnostic>>()?;
    let settled = shards.iter().flat_map(|s| &s.frames).filter(|f| f.settled).count();
    let (objects, infos): (Vec<_>, Vec<_>) =
        shards.into_iter().map(|s| (s.object, s.frames)).unzip();
    let frames = infos.iter().map(Vec::len).sum();
    let index =
        Index { schema: 1, seed: plan.seed, command: plan.command.clone(), objects, shards: infos };
    frames::write_index(folder, &index)?;
    Ok(Summary { frames, settled, resumed: resumed.into_inner() })
}

fn make(plan: &Plan, folder: &Path, number: usize, object: &Object) -> Result<Shard, Diagnostic> {
    let worn = worn(object, &Settings::default()).map_err(|e| no_canonical_state(object, &e))?;
    let frames: Vec<frames::Frame> = (0..plan.drops_per_object)
        .into_par_iter()
        .flat_map_iter(|drop| view::frames_of_drop(plan, number, &worn.canonical, drop))
        .collect();
    frames::write_shard(folder, number, &frames)?;
    let infos = frames.into_iter().map(|f| f.info).collect();
    let shard = Shard { key: Shard::key(plan, number), object: worn.canonical, frames: infos };
    shard.write(folder, number)?;
    Ok(shard)
}

fn no_canonical_state(object: &Object, fault: &WornFault) -> Diagnostic {
    Diagnostic::new("D010", format!("{}: {fault}", object.name()))
        .hint("leave this object out, or give it a circumference that fits the head")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::category::cap;
    use std::fs;

    fn plan() -> Plan {
        Plan {
            objects: vec![cap::named("cap-train-000").expect("a cap")],
            drops_per_object: 2,
            views: 1,
            seed: 3,
            command: "test".into(),
        }
    }

    #[test]
    fn the_set_is_the_same_on_one_thread_resumes_and_its_labels_lie_on_the_mesh() {
        let [one, many] = [0, 1].map(|_| tempfile::tempdir().expect("a folder"));
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool");
        let first = pool.install(|| generate(&plan(), one.path(), &|_| ())).expect("made");
        generate(&plan(), many.path(), &|_| ()).expect("made");
        for name in ["frames-0000.safetensors", "index.json"] {
            let read = |folder: &Path| fs::read(folder.join(name)).expect("a file");
            assert!(read(one.path()) == read(many.path()), "{name} differs");
        }
        let again = generate(&plan(), one.path(), &|_| ()).expect("made");
        assert_eq!((first.resumed, again.resumed), (0, 1));
        assert_eq!(first.frames, again.frames);

        let index = frames::read_index(one.path()).expect("an index");
        let object = &index.objects[0];
        for frame in frames::read_shard(one.path(), 0, &index.shards[0]).expect("frames") {
            assert!(frame.points.len() <= view::MOST_POINTS);
            for n in &frame.nocs {
                let near = object.vertices.iter().any(|v| {
                    (0..3).map(|k| (v[k] - f64::from(n[k])).powi(2)).sum::<f64>() < 0.08f64.powi(2)
                });
                assert!(near, "{n:?} is far from the canonical mesh");
            }
        }
    }
}
