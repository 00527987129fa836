//! What can go wrong between a canonical cloud and its field.

use seeone_core::Diagnostic;
use seeone_nn::TrainError;
use seeone_plugin::PluginError;

/// Why there is no encoding.
#[derive(Debug, thiserror::Error)]
pub enum NseError {
    /// The cloud cannot be encoded.
    #[error("the canonical cloud cannot be encoded: {0}")]
    Cloud(String),
    /// A file is missing, damaged, or does not belong to the others.
    #[error("{0}")]
    File(#[from] Diagnostic),
    /// The training set cannot be learnt from.
    #[error("the training set cannot be learnt from: {0}")]
    Data(String),
    /// The frozen perception failed, as opposed to refusing a cloud.
    #[error("perception: {0}")]
    Perception(PluginError),
    /// The training could not go on.
    #[error(transparent)]
    Training(#[from] TrainError),
    /// A tensor operation failed.
    #[error("network: {0}")]
    Network(#[from] candle_core::Error),
}

impl From<NseError> for PluginError {
    fn from(error: NseError) -> Self {
        match error {
            NseError::Cloud(_) => Self::Input(error.to_string()),
            NseError::File(_) | NseError::Data(_) => Self::Resource(error.to_string()),
            NseError::Perception(fault) => fault,
            NseError::Training(_) | NseError::Network(_) => Self::Internal(error.to_string()),
        }
    }
}
