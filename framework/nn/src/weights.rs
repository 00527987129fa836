//! Stored weights: one safetensors file a network, checked against its card.

use crate::Parameters;
use crate::card::{TensorEntry, WeightsEntry};
use candle_core::{Device, Tensor};
use half::f16;
use safetensors::tensor::TensorView;
use safetensors::{Dtype, SafeTensors};
use seeone_core::Diagnostic;
use seeone_core::frames::write_whole;
use std::path::Path;

/// How numbers are stored. Computation is in single precision either way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// Two bytes a number: half the size, a relative error of 5e-4 a weight.
    Half,
    /// Four bytes a number.
    Single,
}

fn fault(path: &Path, cause: impl std::fmt::Display) -> Diagnostic {
    Diagnostic::new("W002", cause.to_string()).in_file(path)
}

fn bytes(values: &[f32], precision: Precision) -> Vec<u8> {
    match precision {
        Precision::Half => values.iter().flat_map(|v| f16::from_f32(*v).to_le_bytes()).collect(),
        Precision::Single => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
    }
}

/// Writes the variables of a network to `path` and returns the card's entry for the file.
///
/// # Errors
/// A located diagnostic when a value is not finite (in `precision`) or the file cannot be
/// written.
pub fn save(
    path: &Path,
    parameters: &Parameters,
    precision: Precision,
) -> Result<WeightsEntry, Diagnostic> {
    let (dtype, dtype_name) = match precision {
        Precision::Half => (Dtype::F16, "f16"),
        Precision::Single => (Dtype::F32, "f32"),
    };
    let mut stored = Vec::new();
    for (name, var) in parameters.entries() {
        let values =
            var.flatten_all().and_then(|t| t.to_vec1::<f32>()).map_err(|e| fault(path, e))?;
        let limit = if precision == Precision::Half { f16::MAX.to_f32() } else { f32::MAX };
        if !values.iter().all(|v| v.abs() <= limit) {
            return Err(fault(path, format!("{name} holds a number that cannot be stored")));
        }
        stored.push((name, var.dims().to_vec(), bytes(&values, precision)));
    }
    let mut views = Vec::new();
    for (name, shape, data) in &stored {
        let view = TensorView::new(dtype, shape.clone(), data).map_err(|e| fault(path, e))?;
        views.push((*name, view));
    }
    let file = safetensors::serialize(views, None).map_err(|e| fault(path, e))?;
    write_whole(path, &file).map_err(|e| fault(path, e))?;
    let tensors = stored.iter().map(|(name, shape, _)| TensorEntry {
        name: (*name).to_owned(),
        shape: shape.clone(),
        dtype: dtype_name.to_owned(),
    });
    Ok(WeightsEntry {
        file: path.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default(),
        blake3: blake3::hash(&file).to_hex().to_string(),
        tensors: tensors.collect(),
    })
}

/// Fills the variables of a network from `path`, which `entry` of a card describes.
///
/// # Errors
/// A located diagnostic when the file is missing, is not the card's, or does not hold
/// exactly the network's variables with finite values. The variables are then unchanged,
/// or partly replaced: do not use the network.
pub fn load(path: &Path, parameters: &Parameters, entry: &WeightsEntry) -> Result<(), Diagnostic> {
    let file = std::fs::read(path).map_err(|e| fault(path, e))?;
    if blake3::hash(&file).to_hex().as_str() != entry.blake3 {
        return Err(fault(
            path,
            "the weights are not those that the card describes (blake3 differs)",
        ));
    }
    let tensors = SafeTensors::deserialize(&file).map_err(|e| fault(path, e))?;
    let expected = parameters.entries().count();
    if tensors.len() != expected {
        return Err(fault(path, format!("{} tensors for a network of {expected}", tensors.len())));
    }
    for (name, var) in parameters.entries() {
        let tensor = tensors.tensor(name).map_err(|e| fault(path, e))?;
        if tensor.shape() != var.dims() {
            let cause = format!("{name} has shape {:?}, not {:?}", tensor.shape(), var.dims());
            return Err(fault(path, cause));
        }
        let values: Vec<f32> = match tensor.dtype() {
            Dtype::F16 => tensor
                .data()
                .chunks_exact(2)
                .map(|b| f16::from_le_bytes([b[0], b[1]]).to_f32())
                .collect(),
            Dtype::F32 => tensor
                .data()
                .chunks_exact(4)
                .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
                .collect(),
            other => return Err(fault(path, format!("{name} has type {other:?}"))),
        };
        if !values.iter().all(|v| v.is_finite()) {
            return Err(fault(path, format!("{name} holds a number that is not finite")));
        }
        let filled = Tensor::from_vec(values, var.dims(), &Device::Cpu).and_then(|t| var.set(&t));
        filled.map_err(|e| fault(path, e))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn network(seed: u64, columns: usize) -> Parameters {
        let mut parameters = Parameters::new(seed);
        parameters.weight("a", 3, columns, 1.0).expect("a");
        parameters.constant("b", 2, 0.5).expect("b");
        parameters
    }

    #[test]
    fn weights_survive_in_both_precisions() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("w.safetensors");
        let (from, to) = (network(1, 4), network(2, 4));
        let entry = save(&path, &from, Precision::Single).expect("saved");
        load(&path, &to, &entry).expect("loaded");
        assert_eq!(from.values().expect("values"), to.values().expect("values"));
        let entry = save(&path, &from, Precision::Half).expect("saved");
        load(&path, &to, &entry).expect("loaded");
        for (a, b) in from.values().expect("values").iter().zip(to.values().expect("values")) {
            assert!((a - b).abs() < 1e-3 * a.abs().max(1e-2));
        }
    }

    #[test]
    fn refuses_other_shapes_other_files_and_nan() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("w.safetensors");
        let from = network(1, 4);
        let entry = save(&path, &from, Precision::Half).expect("saved");
        assert!(load(&path, &network(1, 5), &entry).is_err());
        let mut changed = std::fs::read(&path).expect("bytes");
        let last = changed.len() - 1;
        changed[last] ^= 1;
        std::fs::write(&path, changed).expect("changed");
        assert!(load(&path, &from, &entry).is_err());
        from.set_values(&[f32::NAN; 14]).expect("set");
        assert!(save(&path, &from, Precision::Half).is_err());
    }
}
