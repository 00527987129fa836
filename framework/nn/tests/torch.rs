//! The operations against PyTorch: values and gradients that `benches/torch_references.py`
//! stored in `torch.safetensors`.

#![allow(clippy::expect_used, reason = "tests")]

use candle_core::{DType, Device, Result, Tensor, Var};
use seeone_nn::conv3d::{Stride, conv3d};
use seeone_nn::ops::{
    Activation, BinTargets, Neighborhoods, attention, cross_entropy, interpolate, layer_norm,
    linear_biased, set_abstraction,
};
use seeone_nn::sampling::{Point, three_nearest};
use seeone_nn::volume::{Trilinear, trilinear};
use std::collections::HashMap;

/// Sums in another order differ by this much, of numbers of some units.
const TOLERANCE: f32 = 2e-5;

/// What is stored of one operation.
struct Case {
    name: &'static str,
    stored: HashMap<String, Tensor>,
    variables: HashMap<String, Var>,
}

impl Case {
    fn open(name: &'static str) -> Self {
        let file = include_bytes!("torch.safetensors");
        let all = candle_core::safetensors::load_buffer(file, &Device::Cpu).expect("a file");
        let prefix = format!("{name}.");
        let stored: HashMap<String, Tensor> = all
            .into_iter()
            .filter_map(|(key, x)| Some((key.strip_prefix(&prefix)?.to_owned(), x)))
            .collect();
        let variables = stored
            .keys()
            .filter_map(|key| key.strip_suffix(".gradient"))
            .map(|key| (key.to_owned(), Var::from_tensor(&stored[key]).expect("a variable")))
            .collect();
        Self { name, stored, variables }
    }

    /// An input as a tensor, a variable if torch had its gradient.
    fn input(&self, name: &str) -> Tensor {
        self.variables
            .get(name)
            .map_or_else(|| self.stored[name].clone(), |v| v.as_tensor().clone())
    }

    fn numbers(&self, name: &str) -> Vec<f32> {
        self.stored[name].flatten_all().and_then(|x| x.to_vec1()).expect("numbers")
    }

    fn points(&self, name: &str) -> Vec<Point> {
        self.numbers(name).chunks_exact(3).map(|p| [p[0], p[1], p[2]]).collect()
    }

    /// Compares `output` and its gradients with torch's.
    fn check(&self, output: Result<Tensor>) {
        let output = output.expect("an output");
        let name = self.name;
        let near = |what: &str, ours: &Tensor, theirs: &Tensor| {
            let furthest = (ours - theirs)
                .and_then(|d| d.abs()?.flatten_all()?.max(0)?.to_scalar::<f32>())
                .expect("a distance");
            assert!(furthest < TOLERANCE, "{name}: {what} is off by {furthest}");
        };
        near("the output", &output, &self.stored["output"]);
        let loss = (&output * &self.stored["probe"]).and_then(|l| l.sum_all()).expect("a loss");
        let gradients = loss.backward().expect("gradients");
        assert!(!self.variables.is_empty());
        for (input, variable) in &self.variables {
            let ours = gradients.get(variable).expect("a gradient");
            near(
                &format!("the gradient of {input}"),
                ours,
                &self.stored[&format!("{input}.gradient")],
            );
        }
    }
}

#[test]
fn affine_maps() {
    let case = Case::open("linear");
    let [x, w, b] = ["x", "w", "b"].map(|name| case.input(name));
    case.check(linear_biased(&x, &w, &b, Activation::Relu));
}

#[test]
fn layer_normalisation() {
    let case = Case::open("layer_norm");
    let [x, scale, shift] = ["x", "scale", "shift"].map(|name| case.input(name));
    case.check(layer_norm(&x, &scale, &shift, Activation::Identity));
}

#[test]
fn set_abstraction_as_it_is_usually_written() {
    let case = Case::open("set_abstraction");
    let [features, points, centres, first, bias, second] =
        ["features", "points", "centres", "first", "bias", "second"].map(|name| case.input(name));
    let rows = case.numbers("near").iter().map(|row| *row as u32).collect();
    let ours = || {
        let h = Tensor::cat(&[&features, &points], 1)?.matmul(&first)?.broadcast_add(&bias)?;
        let c = centres.matmul(&first.narrow(0, 4, 3)?.contiguous()?)?;
        set_abstraction(&h, &c, &second, Neighborhoods { rows, size: 5 })
    };
    case.check(ours());
}

#[test]
fn interpolation_from_the_three_nearest() {
    let case = Case::open("three_nearest");
    let table = three_nearest(&case.points("targets"), &case.points("sources"));
    case.check(interpolate(&case.input("features"), table));
}

#[test]
fn attention_of_two_heads() {
    let case = Case::open("attention");
    case.check(attention(&case.input("qkv"), 6, 2));
}

#[test]
fn cross_entropy_over_soft_bins() {
    let case = Case::open("cross_entropy");
    let targets = BinTargets {
        values: case.numbers("values"),
        weights: case.numbers("weights"),
        softness: 1.5,
    };
    case.check(cross_entropy(&case.input("logits"), targets).and_then(|loss| loss.reshape(1)));
}

#[test]
fn convolution_with_both_strides() {
    for (name, stride) in [("conv3d", Stride::One), ("conv3d_stride_2", Stride::Two)] {
        let case = Case::open(name);
        assert_eq!(case.stored["x"].dtype(), DType::F32);
        case.check(conv3d(&case.input("x"), &case.input("w"), 6, stride));
    }
}

#[test]
fn trilinear_reading() {
    let case = Case::open("trilinear");
    let queries = case.points("queries");
    let (first, second) = queries.split_at(11);
    case.check(trilinear(&case.input("grids"), &Trilinear::new(&[first, second], 5)));
}
