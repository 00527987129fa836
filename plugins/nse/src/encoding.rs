//! The trained encoding and the fields it makes.

use crate::network::{Network, SIDES, Volume};
use crate::{Input, NseError, OWN_COLUMNS};
use candle_core::{Device, Tensor};
use nalgebra::Point3;
use seeone_core::Diagnostic;
use seeone_nn::card::CARD_NAME;
use seeone_nn::volume::Occupancy;
use seeone_nn::{Card, Parameters, weights};
use seeone_plugin::{CanonicalCloud, Encoding, Features, Field, PluginError};
use std::path::Path;
use std::sync::Arc;

/// Name of the file of weights beside its card.
pub(crate) const WEIGHTS_NAME: &str = "nse.safetensors";
/// Name of the network in its card.
pub(crate) const NETWORK_NAME: &str = "nse";
/// Queries answered at once: bounds the memory that a dense grid of them takes.
const MOST_QUERIES: usize = 16_384;

/// The neural spatial encoding with its weights.
pub struct Nse {
    network: Arc<Network>,
    /// Length of an input row.
    columns: usize,
}

impl Nse {
    pub(crate) fn new(parameters: &mut Parameters, columns: usize) -> Result<Self, NseError> {
        Ok(Self { network: Arc::new(Network::new(parameters, columns)?), columns })
    }

    /// Length of an input row: [`crate::OWN_COLUMNS`] and the perception's features.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Loads weights and their card from `folder`. `perception` is the folder of the
    /// perception's weights: features of others than those that the card requires would
    /// be noise to this network.
    ///
    /// # Errors
    /// [`NseError::File`] when a file is missing or damaged, or when the perception's card
    /// names other weights than this one's requires.
    pub fn load(folder: &Path, perception: &Path) -> Result<Self, NseError> {
        let card = Card::read(folder)?;
        let path = folder.join(CARD_NAME);
        let refuse = |cause: String| Diagnostic::new("W003", cause).in_file(&path);
        if card.network != NETWORK_NAME {
            return Err(refuse(format!("the card is of a network \"{}\"", card.network)).into());
        }
        if card.requires != requirements(&Card::read(perception)?) {
            let cause =
                format!("trained on other perception weights than {}", perception.display());
            return Err(refuse(cause)
                .hint("train this encoding again, or name its perception")
                .into());
        }
        let (entry, file) = card.entry(folder, WEIGHTS_NAME)?;
        let columns = entry.tensors.iter().find(|t| t.name == "point.0.weight");
        let Some(columns) = columns.and_then(|t| t.shape.first()).filter(|c| **c > OWN_COLUMNS)
        else {
            return Err(refuse("no usable first layer in the card".into()).into());
        };
        let mut parameters = Parameters::new(card.seed);
        let nse = Self::new(&mut parameters, *columns)?;
        weights::load(&file, &parameters, entry)?;
        Ok(nse)
    }

    /// Encodes a cloud that was laid out before.
    ///
    /// # Errors
    /// [`NseError::Cloud`] when its rows have another length than the network's.
    pub fn encode_input(&self, input: &Input) -> Result<NseField, NseError> {
        if input.columns != self.columns {
            let (got, wanted) = (input.columns - OWN_COLUMNS, self.columns - OWN_COLUMNS);
            return Err(NseError::Cloud(format!("{got} features a point instead of {wanted}")));
        }
        let shape = (input.positions.len(), input.columns);
        let rows = Tensor::from_slice(&input.rows, shape, &Device::Cpu)?;
        let occupancy = Occupancy::new(&[&input.positions], SIDES[0]);
        let volume = self.network.volume(&rows, &occupancy)?;
        // Without this the field would keep every intermediate result for a backward pass.
        let volume = Volume { fine: volume.fine.detach(), middle: volume.middle.detach() };
        Ok(NseField { network: Arc::clone(&self.network), volume })
    }

    pub(crate) fn network(&self) -> &Network {
        &self.network
    }
}

/// What a perception's card contributes to the `requires` of this encoding's.
pub(crate) fn requirements(perception: &Card) -> std::collections::BTreeMap<String, String> {
    perception.weights.iter().map(|w| (w.file.clone(), w.blake3.clone())).collect()
}

impl Encoding for Nse {
    fn encode(&mut self, cloud: &CanonicalCloud) -> Result<Box<dyn Field>, PluginError> {
        cloud.check().map_err(NseError::Cloud)?;
        Ok(Box::new(self.encode_input(&Input::new(cloud)?)?))
    }
}

/// The feature volume of one cloud and the network that reads it.
pub struct NseField {
    network: Arc<Network>,
    volume: Volume,
}

impl NseField {
    /// The outputs of M's layers, joined: Q x 257.
    fn layers(&self, queries: &[[f32; 3]]) -> [Tensor; 3] {
        self.network
            .query(&self.volume, &[queries])
            .expect("a field's grids have the shapes that its own network gave them")
    }
}

/// Query points in single precision.
fn single(queries: &[Point3<f64>]) -> Vec<[f32; 3]> {
    queries.iter().map(|q| [q.x as f32, q.y as f32, q.z as f32]).collect()
}

/// The numbers of a CPU tensor.
fn numbers(tensor: &Tensor) -> Vec<f32> {
    let numbers = tensor.flatten_all().and_then(|t| t.to_vec1());
    numbers.expect("a tensor of single precision on the CPU")
}

impl Field for NseField {
    fn features(&self, queries: &[Point3<f64>]) -> Features {
        let mut features = Features::default();
        for queries in single(queries).chunks(MOST_QUERIES) {
            let layers = self.layers(queries);
            let joined = Tensor::cat(&layers, 1).expect("layers of one set of queries");
            features.width = joined.dims()[1];
            features.values.extend(numbers(&joined));
        }
        features
    }

    fn winding(&self, queries: &[Point3<f64>]) -> Option<Vec<f64>> {
        let queries = single(queries);
        let read = |queries: &[[f32; 3]]| numbers(&self.layers(queries)[2]);
        Some(queries.chunks(MOST_QUERIES).flat_map(read).map(f64::from).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_clouds::{WIDTH, cloud};

    fn untrained() -> Nse {
        Nse::new(&mut Parameters::new(1), OWN_COLUMNS + WIDTH).expect("a network")
    }

    fn grid(n: usize) -> Vec<Point3<f64>> {
        let at = |i: usize| (i as f64 + 0.5) / n as f64;
        (0..n * n * n).map(|i| Point3::new(at(i % n), at(i / n % n), at(i / n / n))).collect()
    }

    #[test]
    fn the_last_feature_is_the_winding_number_however_many_are_asked_at_once() {
        let field = untrained().encode(&cloud(0, 300)).expect("a field");
        let queries = grid(26); // more than one portion
        let features = field.features(&queries);
        let winding = field.winding(&queries).expect("windings");
        assert_eq!(features.values.len(), queries.len() * features.width);
        for (row, w) in features.values.chunks_exact(features.width).zip(&winding) {
            assert_eq!(f64::from(row[features.width - 1]), *w);
        }
        let alone = field.features(&queries[17_000..17_001]);
        let together = &features.values[17_000 * features.width..][..features.width];
        let worst =
            alone.values.iter().zip(together).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(worst < 1e-5, "{worst}");
    }

    #[test]
    fn refuses_the_features_of_another_perception() {
        let mut other = cloud(0, 100);
        other.feature_width = WIDTH / 2;
        other.features.truncate(100 * WIDTH / 2);
        assert!(matches!(untrained().encode(&other), Err(PluginError::Input(_))));
        assert!(untrained().encode(&CanonicalCloud::default()).is_err());
    }
}
