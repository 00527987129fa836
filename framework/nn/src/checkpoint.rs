//! The state of an interrupted training: one safetensors file, replaced in one step.

use crate::optimizer::AdamW;
use crate::{Parameters, Plan};
use safetensors::tensor::TensorView;
use safetensors::{Dtype, SafeTensors};
use seeone_core::frames::write_whole;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Why a checkpoint is of no use.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointError {
    /// The file cannot be read or written.
    #[error("checkpoint {0}: {1}")]
    File(PathBuf, std::io::Error),
    /// The file is damaged.
    #[error("checkpoint {0} is damaged: {1}")]
    Damaged(PathBuf, String),
    /// The file was written by a training with another plan, network or seed.
    #[error("checkpoint {0} belongs to another training; move it away to start afresh")]
    Foreign(PathBuf),
}

/// What a checkpoint must agree in with the training that reads it.
pub fn fingerprint(parameters: &Parameters, plan: &Plan) -> String {
    let mut hash = blake3::Hasher::new();
    let Plan { label, samples, batch, peak_rate, .. } = plan;
    hash.update(format!("{label}\n{samples}\n{batch}\n{peak_rate}\n").as_bytes());
    for (name, var) in parameters.entries() {
        hash.update(format!("{name} {:?}\n", var.dims()).as_bytes());
    }
    hash.finalize().to_hex().to_string()
}

/// Writes values, optimiser state and the number of samples seen.
///
/// # Errors
/// [`CheckpointError::File`].
pub fn write(
    path: &Path,
    fingerprint: &str,
    values: &[f32],
    adam: &AdamW,
    done: u64,
) -> Result<(), CheckpointError> {
    let bytes = |v: &[f32]| -> Vec<u8> { v.iter().flat_map(|x| x.to_le_bytes()).collect() };
    let stored =
        [("values", bytes(values)), ("first", bytes(&adam.first)), ("second", bytes(&adam.second))];
    let damaged =
        |e: safetensors::SafeTensorError| CheckpointError::Damaged(path.into(), e.to_string());
    let mut views = Vec::new();
    for (name, data) in &stored {
        views
            .push((*name, TensorView::new(Dtype::F32, vec![values.len()], data).map_err(damaged)?));
    }
    let notes = HashMap::from([(
        "state".to_owned(),
        format!("{fingerprint} {done} {}", adam.steps), // one entry: a map has no order
    )]);
    let file = safetensors::serialize(views, Some(notes)).map_err(damaged)?;
    write_whole(path, &file).map_err(|e| CheckpointError::File(path.into(), e))
}

/// Reads what [`write()`] wrote for a network of `count` parameters.
///
/// # Errors
/// [`CheckpointError`].
pub fn read(
    path: &Path,
    fingerprint: &str,
    count: usize,
) -> Result<(Vec<f32>, AdamW, u64), CheckpointError> {
    let damaged = |why: &str| CheckpointError::Damaged(path.into(), why.into());
    let bytes = std::fs::read(path).map_err(|e| CheckpointError::File(path.into(), e))?;
    let (_, header) = SafeTensors::read_metadata(&bytes).map_err(|e| damaged(&e.to_string()))?;
    let notes = header
        .metadata()
        .as_ref()
        .and_then(|m| m.get("state"))
        .ok_or_else(|| damaged("no state"))?;
    let mut words = notes.split(' ');
    if words.next() != Some(fingerprint) {
        return Err(CheckpointError::Foreign(path.into()));
    }
    let mut number =
        || words.next().and_then(|w| w.parse::<u64>().ok()).ok_or_else(|| damaged("no count"));
    let (done, steps) = (number()?, number()?);
    let tensors = SafeTensors::deserialize(&bytes).map_err(|e| damaged(&e.to_string()))?;
    let numbers = |name: &str| -> Result<Vec<f32>, CheckpointError> {
        let tensor = tensors.tensor(name).map_err(|e| damaged(&e.to_string()))?;
        let values: Vec<f32> = tensor
            .data()
            .chunks_exact(4)
            .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
            .collect();
        if tensor.dtype() != Dtype::F32 || values.len() != count {
            return Err(damaged("sizes do not agree"));
        }
        if !values.iter().all(|v| v.is_finite()) {
            return Err(damaged("a number is not finite"));
        }
        Ok(values)
    };
    let values = numbers("values")?;
    Ok((values, AdamW { first: numbers("first")?, second: numbers("second")?, steps }, done))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refuses_what_is_foreign_or_cut_short() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.checkpoint");
        let adam = AdamW { first: vec![0.5; 3], second: vec![0.25; 3], steps: 7 };
        write(&path, "mine", &[1.0, 2.0, 3.0], &adam, 56).expect("written");
        let (values, back, done) = read(&path, "mine", 3).expect("read");
        assert_eq!((values, back, done), (vec![1.0, 2.0, 3.0], adam, 56));
        assert!(matches!(read(&path, "other", 3), Err(CheckpointError::Foreign(_))));
        assert!(matches!(read(&path, "mine", 4), Err(CheckpointError::Damaged(..))));
        let bytes = std::fs::read(&path).expect("bytes");
        std::fs::write(&path, &bytes[..bytes.len() - 3]).expect("cut");
        assert!(matches!(read(&path, "mine", 3), Err(CheckpointError::Damaged(..))));
    }
}
