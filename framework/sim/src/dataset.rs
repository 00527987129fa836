//! Training sets: drops of many objects, seen by the depth camera while they fall, lie and
//! hang from a gripper, every point with its canonical coordinates.

mod drop;
mod held;
mod shard;
mod view;

use crate::object::Object;
use crate::world::Settings;
use crate::worn::{WornFault, worn};
use drop::Dropped;
use rayon::prelude::*;
use seeone_core::Diagnostic;
use seeone_core::frames::{self, Frame, FrameInfo, Index, Moment, SCHEMA};
use serde::Serialize;
use shard::Shard;
use std::num::NonZeroUsize;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What to generate.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The objects, one shard each.
    pub objects: Vec<Object>,
    /// Frames in all, exactly. Each object gets as many as any other, or one less; with
    /// fewer frames than objects the last objects get none and are left out.
    pub frames: NonZeroUsize,
    /// Views of each moment, from as many sides.
    pub views: NonZeroUsize,
    /// Seed of every draw.
    pub seed: u64,
    /// The command that the index shall name.
    pub command: String,
}

impl Plan {
    /// How many of the objects are seen.
    fn seen(&self) -> usize {
        self.objects.len().min(self.frames.get())
    }

    /// Frames of object `number`.
    fn frames_of(&self, number: usize) -> usize {
        let (whole, rest) = (self.frames.get() / self.seen(), self.frames.get() % self.seen());
        whole + usize::from(number < rest)
    }
}

/// How far a generation has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Frames done.
    pub done: usize,
    /// Frames in all.
    pub total: usize,
}

/// What was generated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Summary {
    /// Objects in the set.
    pub objects: usize,
    /// Frames that show an object falling or rocking.
    pub falling: usize,
    /// Frames that show one at rest.
    pub resting: usize,
    /// Frames that show one in the gripper.
    pub held: usize,
    /// Objects that were found done and not made again.
    pub resumed: usize,
}

impl Summary {
    /// Frames in the set.
    pub fn frames(&self) -> usize {
        self.falling + self.resting + self.held
    }
}

/// An object that gives so many times fewer frames than drops has something wrong with it.
const MOST_DROPS_A_FRAME: usize = 3;

/// Generates the set into `folder`, which must exist. A shard that is there already, whole
/// and of the same plan, is kept, so that an interrupted generation goes on where it
/// stopped. The bytes do not depend on the number of threads.
///
/// # Errors
/// `D001` when a file cannot be written, `D010` when an object has no worn state, `D011`
/// when the folder holds another plan's set, `D012` when an object is hardly ever seen.
pub fn generate(
    plan: &Plan,
    folder: &Path,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Summary, Diagnostic> {
    let found = (0..plan.seen())
        .map(|number| Shard::found(plan, folder, number))
        .collect::<Result<Vec<_>, _>>()?;
    let resumed = found.iter().flatten().count();
    let done = AtomicUsize::new(0);
    let tell = |more: usize| {
        let done = done.fetch_add(more, Ordering::Relaxed) + more;
        progress(Progress { done, total: plan.frames.get() });
    };
    tell(found.iter().flatten().map(|shard| shard.frames.len()).sum());
    let shards: Vec<Shard> = found
        .into_par_iter()
        .enumerate()
        .map(|(number, found)| found.map_or_else(|| make(plan, folder, number, &tell), Ok))
        .collect::<Result<_, Diagnostic>>()?;
    let (objects, infos): (Vec<_>, Vec<Vec<FrameInfo>>) =
        shards.into_iter().map(|s| (s.object, s.frames)).unzip();
    let count = |moment| infos.iter().flatten().filter(|f| f.moment == moment).count();
    let summary = Summary {
        objects: objects.len(),
        falling: count(Moment::Falling),
        resting: count(Moment::Resting),
        held: count(Moment::Held),
        resumed,
    };
    let (seed, command) = (plan.seed, plan.command.clone());
    frames::write_index(folder, &Index { schema: SCHEMA, seed, command, objects, shards: infos })?;
    Ok(summary)
}

/// Makes and writes the shard of object `number`: drop after drop, until there are frames
/// enough. What a drop gives does not depend on the others.
fn make(
    plan: &Plan,
    folder: &Path,
    number: usize,
    tell: &(dyn Fn(usize) + Sync),
) -> Result<Shard, Diagnostic> {
    let object = &plan.objects[number];
    let worn = worn(object, &Settings::default()).map_err(|e| no_canonical_state(object, &e))?;
    let dropped = Dropped::new(plan, number, &worn.canonical);
    let (wanted, most_drops) =
        (plan.frames_of(number), MOST_DROPS_A_FRAME * plan.frames_of(number));
    let mut frames: Vec<Frame> = Vec::new();
    let mut drops = 0;
    while frames.len() < wanted {
        if drops > most_drops {
            return Err(hardly_seen(object, frames.len(), drops));
        }
        // A drop gives one to three moments.
        let more = (wanted - frames.len()).div_ceil(2 * plan.views.get());
        let new: Vec<Frame> =
            (drops..drops + more).into_par_iter().flat_map_iter(|d| dropped.frames(d)).collect();
        drops += more;
        let before = frames.len();
        frames.extend(new);
        frames.truncate(wanted);
        tell(frames.len() - before);
    }
    frames::write_shard(folder, number, &frames)?;
    let infos = frames.into_iter().map(|f| f.info).collect();
    let shard = Shard { key: Shard::key(plan, number), object: worn.canonical, frames: infos };
    shard.write(folder, number)?;
    Ok(shard)
}

fn hardly_seen(object: &Object, frames: usize, drops: usize) -> Diagnostic {
    let name = object.name();
    Diagnostic::new("D012", format!("{name}: {drops} drops gave only {frames} frames"))
        .hint("it may be too small for the camera, or diverge: leave this object out")
}

fn no_canonical_state(object: &Object, fault: &WornFault) -> Diagnostic {
    Diagnostic::new("D010", format!("{}: {fault}", object.name()))
        .hint("leave this object out, or give it a circumference that fits the head")
}

#[cfg(test)]
mod tests;
