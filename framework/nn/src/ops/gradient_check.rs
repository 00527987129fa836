//! Finite differences, for tests.

use candle_core::{Result, Tensor, Var};
use seeone_core::random::{generator, normal};

/// A variable of standard normal numbers.
pub(crate) fn variable(seed: u64, shape: &[usize]) -> Var {
    let mut rng = generator(seed, "gradient check");
    let values: Vec<f32> =
        (0..shape.iter().product::<usize>()).map(|_| normal(&mut rng) as f32).collect();
    let device = candle_core::Device::Cpu;
    Var::from_tensor(&Tensor::from_vec(values, shape, &device).expect("a tensor"))
        .expect("a variable")
}

/// Compares the gradient of a weighted sum of `f`'s output with central differences along
/// a few random directions, for each variable alone.
pub(crate) fn check(variables: &[&Var], f: impl Fn() -> Result<Tensor>) {
    const STEP: f32 = 1e-2;
    let output = f().expect("a value");
    // A sum of outputs is blind to operations that conserve it (softmax, layer norm).
    let probe = variable(99, output.dims());
    let value = |probe: &Tensor| -> f64 {
        let product = (f().expect("a value") * probe).expect("same shape");
        product
            .flatten_all()
            .and_then(|t| t.to_vec1::<f32>())
            .expect("numbers")
            .iter()
            .map(|v| f64::from(*v))
            .sum()
    };
    let loss = (&output * probe.as_tensor()).and_then(|t| t.sum_all()).expect("a scalar");
    let gradients = loss.backward().expect("gradients");
    for (which, var) in variables.iter().enumerate() {
        let gradient = gradients.get(var).expect("every variable takes part").clone();
        let start = var.as_tensor().copy().expect("a copy");
        for trial in 0..4 {
            let direction = variable(100 + trial, var.dims());
            let along = |t: f32| {
                let moved = (&start + (direction.as_tensor() * f64::from(t)).expect("scaled"))
                    .expect("sum");
                var.set(&moved).expect("set");
                value(&probe)
            };
            let numeric = (along(STEP) - along(-STEP)) / f64::from(2.0 * STEP);
            var.set(&start).expect("restored");
            let exact = (&gradient * direction.as_tensor())
                .and_then(|t| t.sum_all())
                .and_then(|t| t.to_scalar::<f32>())
                .expect("a number");
            let error = (numeric - f64::from(exact)).abs();
            assert!(
                error < 5e-3 * (1.0 + numeric.abs()),
                "variable {which}: finite differences give {numeric}, backward {exact}"
            );
        }
    }
}
