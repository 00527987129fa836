//! The record beside a shard: whose frames it holds, and of which plan they are.

use super::Plan;
use seeone_core::Diagnostic;
use seeone_core::frames::{CanonicalObject, FrameInfo, SCHEMA, read_shard, write_whole};
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};

/// What `frames-NNNN.json` says about `frames-NNNN.safetensors`.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shard {
    /// Tells the plan and the object's shape: another key is another shard.
    pub key: String,
    /// The object, canonical.
    pub object: CanonicalObject,
    /// Its frames in order.
    pub frames: Vec<FrameInfo>,
}

fn path(folder: &Path, number: usize) -> PathBuf {
    folder.join(format!("frames-{number:04}.json"))
}

impl Shard {
    /// The key of shard `number` of `plan`.
    pub fn key(plan: &Plan, number: usize) -> String {
        let object = &plan.objects[number];
        let mut digest = blake3::Hasher::new();
        let numbers = [plan.objects.len(), plan.frames.get(), plan.views.get()];
        digest.update(format!("{SCHEMA} {} {numbers:?} ", plan.seed).as_bytes());
        digest.update(format!("{} {:?}", object.name(), object.materials()).as_bytes());
        for vertex in object.mesh().vertices() {
            vertex.coords.iter().for_each(|c| {
                digest.update(&c.to_le_bytes());
            });
        }
        digest.finalize().to_hex().to_string()
    }

    /// The shard that is already in `folder`, if it is whole.
    ///
    /// # Errors
    /// `D011` when the record there is another plan's: what it describes is not this
    /// plan's to write over.
    pub fn found(plan: &Plan, folder: &Path, number: usize) -> Result<Option<Self>, Diagnostic> {
        let path = path(folder, number);
        let Ok(text) = fs::read(&path) else { return Ok(None) };
        let ours = |shard: &Self| shard.key == Self::key(plan, number);
        let Some(shard) = serde_json::from_slice(&text).ok().filter(ours) else {
            return Err(Diagnostic::new("D011", "the folder holds the frames of another plan")
                .in_file(&path)
                .hint("name another folder, or remove what is in this one"));
        };
        Ok(read_shard(folder, number, &shard.frames).is_ok().then_some(shard))
    }

    /// Writes the record; the frames must have been written before.
    pub fn write(&self, folder: &Path, number: usize) -> Result<(), Diagnostic> {
        let path = path(folder, number);
        let fault = |cause: String| Diagnostic::new("D001", cause).in_file(&path);
        let text = serde_json::to_vec(self).map_err(|e| fault(e.to_string()))?;
        write_whole(&path, &text).map_err(|e| fault(e.to_string()))
    }
}
