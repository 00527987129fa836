//! The model card beside stored weights: what they are, from what, how good.

use seeone_core::Diagnostic;
use seeone_core::frames::write_whole;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Name of the card in the folder of its weights.
pub const CARD_NAME: &str = "card.toml";

/// One stored tensor.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TensorEntry {
    /// Its name in the file.
    pub name: String,
    /// Its shape.
    pub shape: Vec<usize>,
    /// `f16` or `f32`.
    pub dtype: String,
}

/// One file of weights.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WeightsEntry {
    /// File name beside the card.
    pub file: String,
    /// BLAKE3 of the file, hexadecimal.
    pub blake3: String,
    /// What it holds.
    pub tensors: Vec<TensorEntry>,
}

/// The card.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Card {
    /// Format version, 1.
    pub schema: u32,
    /// Name of the network.
    pub network: String,
    /// Category of objects it knows.
    pub category: String,
    /// Seed of the training data.
    pub data_seed: u64,
    /// Seed of initial weights and of the order of samples.
    pub seed: u64,
    /// The command that trained it.
    pub command: String,
    /// Samples each network saw, by file name without extension.
    pub samples: BTreeMap<String, u64>,
    /// BLAKE3 of the files of weights that these were trained on top of, by name; other
    /// weights there must be refused.
    #[serde(default)]
    pub requires: BTreeMap<String, String>,
    /// Measured figures by name; the name says unit and set.
    #[serde(default)]
    pub figures: BTreeMap<String, f64>,
    /// The files.
    pub weights: Vec<WeightsEntry>,
}

fn fault(path: &Path, cause: impl std::fmt::Display) -> Diagnostic {
    Diagnostic::new("W001", cause.to_string()).in_file(path)
}

impl Card {
    /// Writes the card into `folder`.
    ///
    /// # Errors
    /// A located diagnostic when the file cannot be written.
    pub fn write(&self, folder: &Path) -> Result<(), Diagnostic> {
        let path = folder.join(CARD_NAME);
        let text = toml::to_string(self).map_err(|e| fault(&path, e))?;
        write_whole(&path, text.as_bytes()).map_err(|e| fault(&path, e))
    }

    /// Reads the card of `folder`.
    ///
    /// # Errors
    /// A located diagnostic when there is none or it is malformed.
    pub fn read(folder: &Path) -> Result<Self, Diagnostic> {
        let path = folder.join(CARD_NAME);
        let text = std::fs::read_to_string(&path).map_err(|e| fault(&path, e))?;
        let card: Self = toml::from_str(&text).map_err(|e| {
            let start = e.span().map_or(0, |s| s.start);
            fault(&path, e.message()).at_offset(&path, &text, start)
        })?;
        if card.schema != 1 {
            return Err(fault(&path, format!("schema {} is not known, only 1", card.schema)));
        }
        Ok(card)
    }

    /// The entry of `file` and the file's path in `folder`.
    ///
    /// # Errors
    /// A diagnostic when the card does not name the file.
    pub fn entry(&self, folder: &Path, file: &str) -> Result<(&WeightsEntry, PathBuf), Diagnostic> {
        match self.weights.iter().find(|entry| entry.file == file) {
            Some(entry) => Ok((entry, folder.join(file))),
            None => Err(fault(&folder.join(CARD_NAME), format!("the card does not name {file}"))
                .suggest(file, self.weights.iter().map(|w| w.file.as_str()))),
        }
    }
}
