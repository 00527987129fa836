//! The network: PointNet++ down to a few tokens, attention among them, and back up to any
//! query points (0.5 million parameters).

use crate::batch::Batch;
use crate::stance::PLACE;
use candle_core::{Result, Tensor};
use seeone_nn::Parameters;
use seeone_nn::layers::{FeaturePropagation, Linear, SetAbstraction, Transformer};
use seeone_nn::ops::{Activation, BINS};

/// Columns of the features that a query point gets (the paper's C).
pub const FEATURES: usize = 128;
/// Columns after the first set abstraction.
const FINE: usize = 64;
const ATTENTION_LAYERS: usize = 3;
const HEADS: usize = 4;

/// What tells the two networks apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sizes {
    /// Points of a cloud; a quarter of them become centres, a sixteenth tokens.
    pub points: usize,
    /// Radii of the two set abstractions in network units.
    pub radii: [f32; 2],
}

impl Sizes {
    /// For the cloud as it lies; one network unit is 0.1 m.
    pub const COARSE: Self = Self { points: 512, radii: [0.5, 1.2] };
    /// For the cloud in a first pose. Half of the points for twice the samples is the better
    /// bargain: 68.7 instead of 64.3 % within 0.04 d after the same time.
    pub const REFINER: Self = Self { points: 512, radii: [0.35, 0.9] };

    /// Centres of the first set abstraction.
    pub fn centres(self) -> usize {
        self.points / 4
    }

    /// Centres of the second one.
    pub fn tokens(self) -> usize {
        self.points / 16
    }
}

/// What the network says about the query points of a batch.
pub struct Output {
    /// Rows x [`FEATURES`].
    pub features: Tensor,
    /// Rows x (3 * [`BINS`]): unnormalised log-probabilities of three coordinates.
    pub logits: Tensor,
}

/// The network and its variables.
pub struct Network {
    sizes: Sizes,
    parameters: Parameters,
    fine: SetAbstraction,
    coarse: SetAbstraction,
    position: Linear,
    attention: Vec<Transformer>,
    to_centres: FeaturePropagation,
    to_queries: FeaturePropagation,
    hidden: Linear,
    head: Linear,
}

impl Network {
    /// A network with initial values from `seed`.
    ///
    /// # Errors
    /// What candle reports.
    pub fn new(sizes: Sizes, seed: u64) -> Result<Self> {
        let mut parameters = Parameters::new(seed);
        let p = &mut parameters;
        let fine = SetAbstraction::new(p, "sa1", 3, FINE)?;
        let coarse = SetAbstraction::new(p, "sa2", FINE + 3, FEATURES)?;
        let position = Linear::new(p, "position", PLACE, FEATURES, Activation::Identity)?;
        let attention = (0..ATTENTION_LAYERS)
            .map(|i| Transformer::new(p, &format!("attention{i}"), FEATURES, HEADS, 2 * FEATURES))
            .collect::<Result<_>>()?;
        let to_centres = FeaturePropagation::new(p, "fp1", FEATURES, FINE + 3, FEATURES)?;
        let to_queries = FeaturePropagation::new(p, "fp2", FEATURES, PLACE, FEATURES)?;
        let hidden = Linear::new(p, "hidden", FEATURES, FEATURES, Activation::Relu)?;
        let head = Linear::new(p, "head", FEATURES, 3 * BINS, Activation::Identity)?;
        Ok(Self {
            sizes,
            parameters,
            fine,
            coarse,
            position,
            attention,
            to_centres,
            to_queries,
            hidden,
            head,
        })
    }

    /// How many points it takes.
    pub fn sizes(&self) -> Sizes {
        self.sizes
    }

    /// Its variables.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// Features and logits of every query point of the batch.
    ///
    /// # Errors
    /// When the batch was made for other sizes.
    pub fn forward(&self, batch: &Batch) -> Result<Output> {
        let fine =
            self.fine.forward(&batch.points, &batch.centres, batch.around_centres.clone())?;
        let placed = Tensor::cat(&[&fine, &batch.centres], 1)?;
        let mut tokens =
            (self.coarse.forward(&placed, &batch.tokens, batch.around_tokens.clone())?
                + self.position.forward(&batch.token_places)?)?;
        for layer in &self.attention {
            tokens = layer.forward(&tokens, self.sizes.tokens())?;
        }
        let centres = self.to_centres.forward(&tokens, &placed, batch.tokens_to_centres.clone())?;
        let features = self.to_queries.forward(
            &centres,
            &batch.query_places,
            batch.centres_to_queries.clone(),
        )?;
        let logits = self.head.forward(&self.hidden.forward(&features)?)?;
        Ok(Output { features, logits })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn has_about_half_a_million_parameters() {
        let network = Network::new(Sizes::REFINER, 1).expect("a network");
        assert!((500_000..600_000).contains(&network.parameters().count()));
    }
}
