//! The record beside a shard: whose frames it holds, and of which plan they are.

use super::Plan;
use seeone_core::Diagnostic;
use seeone_core::frames::{CanonicalObject, FrameInfo, read_shard, write_whole};
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
        digest.update(format!("{} {} {}", plan.seed, plan.drops_per_object, plan.views).as_bytes());
        digest.update(object.name().as_bytes());
        for vertex in object.mesh().vertices() {
            vertex.coords.iter().for_each(|c| {
                digest.update(&c.to_le_bytes());
            });
        }
        digest.finalize().to_hex().to_string()
    }

    /// The shard that is already in `folder`, if it is whole and of this plan.
    pub fn found(plan: &Plan, folder: &Path, number: usize) -> Option<Self> {
        let text = fs::read(path(folder, number)).ok()?;
        let shard: Self = serde_json::from_slice(&text).ok()?;
        (shard.key == Self::key(plan, number)).then_some(())?;
        read_shard(folder, number, &shard.frames).ok()?;
        Some(shard)
    }

    /// Writes the record; the frames must have been written before.
    pub fn write(&self, folder: &Path, number: usize) -> Result<(), Diagnostic> {
        let path = path(folder, number);
        let fault = |cause: String| Diagnostic::new("D001", cause).in_file(&path);
        let text = serde_json::to_vec(self).map_err(|e| fault(e.to_string()))?;
        write_whole(&path, &text).map_err(|e| fault(e.to_string()))
    }
}
