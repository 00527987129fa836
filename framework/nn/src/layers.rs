//! Layers: fused operations together with their variables.

use crate::Parameters;
use crate::ops::{self, Activation, attention, interpolate, layer_norm, linear_biased};
use crate::ops::{Neighborhoods, set_abstraction};
use crate::sampling::Interpolation;
use candle_core::{Result, Tensor};

/// An affine map and what follows it.
pub struct Linear {
    weight: Tensor,
    bias: Option<Tensor>,
    activation: Activation,
}

impl Linear {
    /// A map from `inputs` to `outputs` columns.
    ///
    /// # Errors
    /// When the name is taken.
    pub fn new(
        parameters: &mut Parameters,
        name: &str,
        inputs: usize,
        outputs: usize,
        activation: Activation,
    ) -> Result<Self> {
        let bias = parameters.constant(&format!("{name}.bias"), outputs, 0.0)?;
        Ok(Self {
            bias: Some(bias),
            ..Self::unbiased(parameters, name, inputs, outputs, activation)?
        })
    }

    /// As [`Linear::new`], without a bias.
    ///
    /// # Errors
    /// When the name is taken.
    pub fn unbiased(
        parameters: &mut Parameters,
        name: &str,
        inputs: usize,
        outputs: usize,
        activation: Activation,
    ) -> Result<Self> {
        let gain = if activation == Activation::Relu { 2.0 } else { 1.0 };
        let weight = parameters.weight(&format!("{name}.weight"), inputs, outputs, gain)?;
        Ok(Self { weight, bias: None, activation })
    }

    /// Rows x inputs -> rows x outputs.
    ///
    /// # Errors
    /// When the columns do not agree.
    pub fn forward(&self, x: &Tensor) -> Result<Tensor> {
        match &self.bias {
            Some(bias) => linear_biased(x, &self.weight, bias, self.activation),
            None => ops::linear(x, &self.weight, self.activation),
        }
    }
}

/// Layer normalisation and what follows it.
pub struct Norm {
    scale: Tensor,
    shift: Tensor,
    activation: Activation,
}

impl Norm {
    /// For rows of `columns`.
    ///
    /// # Errors
    /// When the name is taken.
    pub fn new(
        parameters: &mut Parameters,
        name: &str,
        columns: usize,
        activation: Activation,
    ) -> Result<Self> {
        Ok(Self {
            scale: parameters.constant(&format!("{name}.scale"), columns, 1.0)?,
            shift: parameters.constant(&format!("{name}.shift"), columns, 0.0)?,
            activation,
        })
    }

    /// Rows x columns -> the same.
    ///
    /// # Errors
    /// When the columns do not agree.
    pub fn forward(&self, x: &Tensor) -> Result<Tensor> {
        layer_norm(x, &self.scale, &self.shift, self.activation)
    }
}

/// Set abstraction with one hidden layer: features of centres from those of their
/// neighbours.
pub struct SetAbstraction {
    point: Linear,
    centre: Linear,
    lift: Tensor,
    norm: Norm,
}

impl SetAbstraction {
    /// `inputs` columns a point (its coordinates among them) -> `outputs` a centre.
    ///
    /// # Errors
    /// When the name is taken.
    pub fn new(
        parameters: &mut Parameters,
        name: &str,
        inputs: usize,
        outputs: usize,
    ) -> Result<Self> {
        let at = |part: &str| format!("{name}.{part}");
        let identity = Activation::Identity;
        Ok(Self {
            point: Linear::new(parameters, &at("point"), inputs, outputs, identity)?,
            centre: Linear::unbiased(parameters, &at("centre"), 3, outputs, identity)?,
            lift: parameters.weight(&at("lift"), outputs, outputs, 2.0)?,
            norm: Norm::new(parameters, &at("norm"), outputs, Activation::Relu)?,
        })
    }

    /// `points`: rows x inputs, `centres`: coordinates of the centres, rows x 3.
    ///
    /// # Errors
    /// When shapes or neighbourhoods do not agree.
    pub fn forward(
        &self,
        points: &Tensor,
        centres: &Tensor,
        neighborhoods: Neighborhoods,
    ) -> Result<Tensor> {
        let (h, c) = (self.point.forward(points)?, self.centre.forward(centres)?);
        self.norm.forward(&set_abstraction(&h, &c, &self.lift, neighborhoods)?)
    }
}

/// Feature propagation: features of coarse points and the fine points' own, mixed.
///
/// The first layer is applied before the interpolation, which commutes with it and has
/// more targets than sources.
pub struct FeaturePropagation {
    coarse: Linear,
    fine: Linear,
    norm: Norm,
    last: Linear,
}

impl FeaturePropagation {
    /// `coarse` and `fine` columns -> `outputs`.
    ///
    /// # Errors
    /// When the name is taken.
    pub fn new(
        parameters: &mut Parameters,
        name: &str,
        coarse: usize,
        fine: usize,
        outputs: usize,
    ) -> Result<Self> {
        let at = |part: &str| format!("{name}.{part}");
        let identity = Activation::Identity;
        Ok(Self {
            coarse: Linear::unbiased(parameters, &at("coarse"), coarse, outputs, identity)?,
            fine: Linear::new(parameters, &at("fine"), fine, outputs, identity)?,
            norm: Norm::new(parameters, &at("norm"), outputs, Activation::Relu)?,
            last: Linear::new(parameters, &at("last"), outputs, outputs, Activation::Relu)?,
        })
    }

    /// `coarse`: sources x columns, `fine`: targets x columns.
    ///
    /// # Errors
    /// When shapes or the table do not agree.
    pub fn forward(&self, coarse: &Tensor, fine: &Tensor, table: Interpolation) -> Result<Tensor> {
        let carried = interpolate(&self.coarse.forward(coarse)?, table)?;
        self.last.forward(&self.norm.forward(&(carried + self.fine.forward(fine)?)?)?)
    }
}

/// One pre-norm transformer layer over the tokens of each cloud.
pub struct Transformer {
    before_attention: Norm,
    queries_keys_values: Linear,
    mix: Linear,
    before_widening: Norm,
    widen: Linear,
    narrow: Linear,
    heads: usize,
}

impl Transformer {
    /// Tokens of `columns` numbers, `heads` heads, a hidden layer of `hidden`.
    ///
    /// # Errors
    /// When the name is taken.
    pub fn new(
        parameters: &mut Parameters,
        name: &str,
        columns: usize,
        heads: usize,
        hidden: usize,
    ) -> Result<Self> {
        let at = |part: &str| format!("{name}.{part}");
        let identity = Activation::Identity;
        Ok(Self {
            before_attention: Norm::new(parameters, &at("norm1"), columns, identity)?,
            queries_keys_values: Linear::new(
                parameters,
                &at("qkv"),
                columns,
                3 * columns,
                identity,
            )?,
            mix: Linear::new(parameters, &at("mix"), columns, columns, identity)?,
            before_widening: Norm::new(parameters, &at("norm2"), columns, identity)?,
            widen: Linear::new(parameters, &at("widen"), columns, hidden, Activation::Relu)?,
            narrow: Linear::new(parameters, &at("narrow"), hidden, columns, identity)?,
            heads,
        })
    }

    /// `x`: clouds of `tokens` rows one after the other.
    ///
    /// # Errors
    /// When the sizes do not divide.
    pub fn forward(&self, x: &Tensor, tokens: usize) -> Result<Tensor> {
        let qkv = self.queries_keys_values.forward(&self.before_attention.forward(x)?)?;
        let x = (x + self.mix.forward(&attention(&qkv, tokens, self.heads)?)?)?;
        let hidden = self.widen.forward(&self.before_widening.forward(&x)?)?;
        &x + self.narrow.forward(&hidden)?
    }
}
