//! The training set: observed clouds with the canonical coordinates of every point, and
//! the canonical meshes they belong to.
//!
//! A folder of `index.json` (what, with which seed) and `frames-NNNN.safetensors` shards.
//! A shard is written to a temporary name and renamed, so that what is there is whole.

use crate::pose::PoseFields;
use crate::{Diagnostic, TriangleMesh};
use nalgebra::Point3;
use safetensors::tensor::TensorView;
use safetensors::{Dtype, SafeTensors};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The version of the format.
pub const SCHEMA: u32 = 2;

/// What the object was doing when it was seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Moment {
    /// Falling, bouncing or still rocking.
    Falling,
    /// Lying still on the mat.
    Resting,
    /// Hanging from a gripper that stands still.
    Held,
}

/// One view of one object at one moment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrameInfo {
    /// Index of the object in [`Index::objects`].
    pub object: usize,
    /// Which drop of that object.
    pub drop: usize,
    /// Seconds since it was let go.
    pub seconds: f64,
    /// What it was doing.
    pub moment: Moment,
    /// The camera in `world`: z along the view, y down the image.
    pub camera: PoseFields,
    /// The rigid pose that carries the canonical shape, centred and in metres
    /// (`edge_m (nocs - 1/2)`), nearest to the object as it is, in `world`.
    pub object_pose: PoseFields,
}

impl FrameInfo {
    /// Whether the object lies still on the mat.
    pub fn at_rest(&self) -> bool {
        self.moment == Moment::Resting
    }
}

/// A view with its points.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// What it shows.
    pub info: FrameInfo,
    /// Observed points in `world` (table top at z = 0), metres.
    pub points: Vec<[f32; 3]>,
    /// Canonical coordinates of the same points, in the unit cube.
    pub nocs: Vec<[f32; 3]>,
}

/// An object of the set in its canonical state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CanonicalObject {
    /// Its name.
    pub name: String,
    /// Vertices in the unit cube (z up, visor along +y, longest box edge 1, centred).
    pub vertices: Vec<[f64; 3]>,
    /// Triangles.
    pub triangles: Vec<[u32; 3]>,
    /// Metres per canonical unit.
    pub edge_m: f64,
    /// Whether its turn about the cube's z axis is arbitrary, as a bucket hat's is.
    #[serde(default)]
    pub round: bool,
}

impl CanonicalObject {
    /// The canonical mesh.
    ///
    /// # Errors
    /// [`crate::mesh::MeshFault`] when the stored numbers are no mesh.
    pub fn mesh(&self) -> Result<TriangleMesh, crate::mesh::MeshFault> {
        let vertices = self.vertices.iter().map(|v| Point3::from(*v)).collect();
        TriangleMesh::new(vertices, self.triangles.clone())
    }
}

/// What a training set holds and how it was made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Index {
    /// Format version, [`SCHEMA`].
    pub schema: u32,
    /// Seed of every draw.
    pub seed: u64,
    /// The command that made it.
    pub command: String,
    /// The objects, canonical.
    pub objects: Vec<CanonicalObject>,
    /// Frames of each shard, in order.
    pub shards: Vec<Vec<FrameInfo>>,
}

/// What is read of an index before its version is known.
#[derive(Deserialize)]
struct Version {
    schema: u32,
}

/// Name of shard `number` inside its folder.
pub fn shard_name(number: usize) -> String {
    format!("frames-{number:04}.safetensors")
}

fn fault(path: &Path, cause: impl std::fmt::Display) -> Diagnostic {
    Diagnostic::new("D001", cause.to_string()).in_file(path)
}

/// Writes `bytes` to `path` in one step: whoever looks sees the old file or the new one.
///
/// # Errors
/// What the file system said.
pub fn write_whole(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    let mut partial = path.as_os_str().to_owned();
    partial.push(".partial");
    fs::write(&partial, bytes).and_then(|()| fs::rename(&partial, path)).inspect_err(|_| {
        // The first fault is the one to tell.
        let _ = fs::remove_file(&partial);
    })
}

/// Writes one shard.
///
/// # Errors
/// A located diagnostic when the file cannot be written.
pub fn write_shard(folder: &Path, number: usize, frames: &[Frame]) -> Result<(), Diagnostic> {
    let path = folder.join(shard_name(number));
    let flat = |pick: fn(&Frame) -> &Vec<[f32; 3]>| -> Vec<u8> {
        frames.iter().flat_map(|f| pick(f).iter().flatten()).flat_map(|v| v.to_le_bytes()).collect()
    };
    let (points, nocs) = (flat(|f| &f.points), flat(|f| &f.nocs));
    let counts: Vec<u8> =
        frames.iter().flat_map(|f| (f.points.len() as u32).to_le_bytes()).collect();
    let rows = points.len() / 12;
    let view =
        |dtype, shape, data| TensorView::new(dtype, shape, data).map_err(|e| fault(&path, e));
    let tensors = BTreeMap::from([
        ("points", view(Dtype::F32, vec![rows, 3], &points)?),
        ("nocs", view(Dtype::F32, vec![rows, 3], &nocs)?),
        ("counts", view(Dtype::U32, vec![frames.len()], &counts)?),
    ]);
    let bytes = safetensors::serialize(tensors, None).map_err(|e| fault(&path, e))?;
    write_whole(&path, &bytes).map_err(|e| fault(&path, e))
}

/// Reads one shard whose frames the index describes as `infos`.
///
/// # Errors
/// A located diagnostic when the file is missing, damaged or does not match the index.
pub fn read_shard(
    folder: &Path,
    number: usize,
    infos: &[FrameInfo],
) -> Result<Vec<Frame>, Diagnostic> {
    let path = folder.join(shard_name(number));
    let bytes = fs::read(&path).map_err(|e| fault(&path, e))?;
    let tensors = SafeTensors::deserialize(&bytes).map_err(|e| fault(&path, e))?;
    let words = |name: &str, dtype: Dtype| -> Result<Vec<[u8; 4]>, Diagnostic> {
        let tensor = tensors.tensor(name).map_err(|e| fault(&path, e))?;
        if tensor.dtype() != dtype {
            return Err(fault(&path, format!("{name} has type {:?}", tensor.dtype())));
        }
        Ok(tensor.data().chunks_exact(4).map(|b| [b[0], b[1], b[2], b[3]]).collect())
    };
    let vectors = |name: &str| -> Result<Vec<[f32; 3]>, Diagnostic> {
        let flat: Vec<f32> = words(name, Dtype::F32)?.into_iter().map(f32::from_le_bytes).collect();
        if !flat.iter().all(|v| v.is_finite()) {
            return Err(fault(&path, format!("{name} holds a number that is not finite")));
        }
        Ok(flat.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect())
    };
    let (points, nocs) = (vectors("points")?, vectors("nocs")?);
    let counts: Vec<usize> =
        words("counts", Dtype::U32)?.into_iter().map(|b| u32::from_le_bytes(b) as usize).collect();
    let total: usize = counts.iter().sum();
    if counts.len() != infos.len() || points.len() != total || nocs.len() != total {
        return Err(fault(&path, "the shard does not match its index"));
    }
    let mut start = 0;
    Ok(infos
        .iter()
        .zip(counts)
        .map(|(info, count)| {
            let range = start..start + count;
            start += count;
            Frame {
                info: info.clone(),
                points: points[range.clone()].to_vec(),
                nocs: nocs[range].to_vec(),
            }
        })
        .collect())
}

/// Writes the index.
///
/// # Errors
/// A located diagnostic when the file cannot be written.
pub fn write_index(folder: &Path, index: &Index) -> Result<(), Diagnostic> {
    let path = folder.join("index.json");
    let text = serde_json::to_vec(index).map_err(|e| fault(&path, e))?;
    write_whole(&path, &text).map_err(|e| fault(&path, e))
}

/// Reads the index of a set.
///
/// # Errors
/// A located diagnostic when there is none or it is malformed.
pub fn read_index(folder: &Path) -> Result<Index, Diagnostic> {
    let path = folder.join("index.json");
    let text = fs::read(&path)
        .map_err(|e| fault(&path, e).hint("make one with `seeone data --out DIR`"))?;
    let located =
        |e: serde_json::Error| fault(&path, &e).at_line(&path, e.line().max(1), e.column().max(1));
    let version: Version = serde_json::from_slice(&text).map_err(located)?;
    if version.schema != SCHEMA {
        let cause = format!("schema {} is not known, only {SCHEMA}", version.schema);
        return Err(fault(&path, cause).hint("make the set anew with `seeone data --out DIR`"));
    }
    let index: Index = serde_json::from_slice(&text).map_err(located)?;
    Ok(index)
}

/// Reads a whole set.
///
/// # Errors
/// As [`read_index`] and [`read_shard`].
pub fn read_all(folder: &Path) -> Result<(Index, Vec<Frame>), Diagnostic> {
    let index = read_index(folder)?;
    let mut frames = Vec::new();
    for (number, infos) in index.shards.iter().enumerate() {
        frames.extend(read_shard(folder, number, infos)?);
    }
    match frames.iter().find(|f| f.info.object >= index.objects.len()) {
        Some(_) => {
            Err(fault(&folder.join("index.json"), "a frame names an object that is not there"))
        }
        None => Ok((index, frames)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Pose;

    #[test]
    fn an_index_of_another_version_is_refused_by_its_number() {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("index.json"), r#"{"schema": 1, "settled": true}"#)
            .expect("written");
        let refused = read_index(folder.path()).expect_err("an old index").to_string();
        assert!(refused.contains("schema 1 is not known"), "{refused}");
    }

    #[test]
    fn a_shard_survives_and_a_truncated_one_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let info = FrameInfo {
            object: 0,
            drop: 3,
            seconds: 1.5,
            moment: Moment::Held,
            camera: (&Pose::translation(0.0, -0.5, 0.5)).into(),
            object_pose: (&Pose::identity()).into(),
        };
        let frames = vec![
            Frame {
                info: info.clone(),
                points: vec![[1.0, 2.0, 3.0]],
                nocs: vec![[0.1, 0.2, 0.3]],
            },
            Frame { info: info.clone(), points: vec![[0.5; 3]; 4], nocs: vec![[0.25; 3]; 4] },
        ];
        write_shard(folder.path(), 0, &frames).expect("written");
        let infos = vec![info.clone(), info];
        assert_eq!(read_shard(folder.path(), 0, &infos).expect("read"), frames);
        assert!(read_shard(folder.path(), 0, &infos[..1]).is_err());
        let path = folder.path().join(shard_name(0));
        let bytes = fs::read(&path).expect("bytes");
        fs::write(&path, &bytes[..bytes.len() - 5]).expect("cut");
        assert!(read_shard(folder.path(), 0, &infos).is_err());
    }
}
