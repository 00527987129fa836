//! `act(x W + b)` in one pass.

use super::{cpu_slice, grad_vec, matrix_shape, storage_slice};
use crate::matmul::{Matrix, MatrixMut, Store, multiply};
use candle_core::{CpuStorage, CustomOp2, CustomOp3, Layout, Result, Shape, Tensor, bail};

/// What follows the affine map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Activation {
    /// Nothing.
    Identity,
    /// `max(0, .)`; its derivative at 0 is taken as 0.
    Relu,
}

struct Linear {
    activation: Activation,
}

impl Linear {
    /// `x` (rows x inputs), `w` (inputs x outputs), the bias (outputs) or nothing.
    fn forward(
        &self,
        x: (&[f32], usize),
        w: (&[f32], usize, usize),
        bias: Option<&[f32]>,
    ) -> Vec<f32> {
        let ((x, rows), (w, inputs, outputs)) = (x, w);
        let mut y = match bias {
            Some(bias) => bias.repeat(rows),
            None => vec![0.0; rows * outputs],
        };
        let (target, a) = (MatrixMut::new(&mut y, rows, outputs), Matrix::new(x, rows, inputs));
        multiply(target, a, Matrix::new(w, inputs, outputs), Store::Add);
        if self.activation == Activation::Relu {
            for v in &mut y {
                *v = v.max(0.0);
            }
        }
        y
    }

    /// Gradients of `x`, `w` and the bias.
    fn backward(
        &self,
        x: &Tensor,
        w: &Tensor,
        y: &Tensor,
        gradient: &Tensor,
    ) -> Result<[Tensor; 3]> {
        let ((rows, inputs), (_, outputs)) = (x.dims2()?, w.dims2()?);
        let mut dy = grad_vec(gradient)?;
        if self.activation == Activation::Relu {
            let (storage, layout) = y.storage_and_layout();
            for (d, y) in dy.iter_mut().zip(storage_slice(&storage, layout)?) {
                *d = if *y > 0.0 { *d } else { 0.0 };
            }
        }
        let (x_storage, x_layout) = x.storage_and_layout();
        let (w_storage, w_layout) = w.storage_and_layout();
        let dy_matrix = Matrix::new(&dy, rows, outputs);
        let (mut dx, mut dw) = (vec![0.0; rows * inputs], vec![0.0; inputs * outputs]);
        multiply(
            MatrixMut::new(&mut dx, rows, inputs),
            dy_matrix,
            Matrix::new(storage_slice(&w_storage, w_layout)?, inputs, outputs).transposed(),
            Store::Replace,
        );
        multiply(
            MatrixMut::new(&mut dw, inputs, outputs),
            Matrix::new(storage_slice(&x_storage, x_layout)?, rows, inputs).transposed(),
            dy_matrix,
            Store::Replace,
        );
        let mut db = vec![0.0; outputs];
        for row in dy.chunks_exact(outputs.max(1)) {
            for (d, v) in db.iter_mut().zip(row) {
                *d += v;
            }
        }
        Ok([
            Tensor::from_vec(dx, (rows, inputs), x.device())?,
            Tensor::from_vec(dw, (inputs, outputs), x.device())?,
            Tensor::from_vec(db, outputs, x.device())?,
        ])
    }
}

fn sizes(x: &Layout, w: &Layout) -> Result<(usize, usize, usize)> {
    let ((rows, inputs), (weight_inputs, outputs)) = (matrix_shape(x)?, matrix_shape(w)?);
    if inputs != weight_inputs {
        bail!("linear: {inputs} columns meet weights for {weight_inputs}");
    }
    Ok((rows, inputs, outputs))
}

impl CustomOp2 for Linear {
    fn name(&self) -> &'static str {
        "linear"
    }

    fn cpu_fwd(
        &self,
        x: &CpuStorage,
        xl: &Layout,
        w: &CpuStorage,
        wl: &Layout,
    ) -> Result<(CpuStorage, Shape)> {
        let (rows, inputs, outputs) = sizes(xl, wl)?;
        let y = self.forward((cpu_slice(x, xl)?, rows), (cpu_slice(w, wl)?, inputs, outputs), None);
        Ok((CpuStorage::F32(y), Shape::from((rows, outputs))))
    }

    fn bwd(
        &self,
        x: &Tensor,
        w: &Tensor,
        y: &Tensor,
        gradient: &Tensor,
    ) -> Result<(Option<Tensor>, Option<Tensor>)> {
        let [dx, dw, _] = self.backward(x, w, y, gradient)?;
        Ok((Some(dx), Some(dw)))
    }
}

impl CustomOp3 for Linear {
    fn name(&self) -> &'static str {
        "linear_biased"
    }

    fn cpu_fwd(
        &self,
        x: &CpuStorage,
        xl: &Layout,
        w: &CpuStorage,
        wl: &Layout,
        b: &CpuStorage,
        bl: &Layout,
    ) -> Result<(CpuStorage, Shape)> {
        let (rows, inputs, outputs) = sizes(xl, wl)?;
        let bias = cpu_slice(b, bl)?;
        if bias.len() != outputs {
            bail!("linear: a bias of {} for {outputs} columns", bias.len());
        }
        let y = self.forward(
            (cpu_slice(x, xl)?, rows),
            (cpu_slice(w, wl)?, inputs, outputs),
            Some(bias),
        );
        Ok((CpuStorage::F32(y), Shape::from((rows, outputs))))
    }

    fn bwd(
        &self,
        x: &Tensor,
        w: &Tensor,
        _b: &Tensor,
        y: &Tensor,
        gradient: &Tensor,
    ) -> Result<(Option<Tensor>, Option<Tensor>, Option<Tensor>)> {
        let [dx, dw, db] = self.backward(x, w, y, gradient)?;
        Ok((Some(dx), Some(dw), Some(db)))
    }
}

/// `act(x W)`: `x` rows x inputs, `w` inputs x outputs.
///
/// # Errors
/// When the shapes do not agree or an argument is not contiguous.
pub fn linear(x: &Tensor, w: &Tensor, activation: Activation) -> Result<Tensor> {
    x.apply_op2(w, Linear { activation })
}

/// `act(x W + b)`: `x` rows x inputs, `w` inputs x outputs, `b` outputs.
///
/// # Errors
/// When the shapes do not agree or an argument is not contiguous.
pub fn linear_biased(x: &Tensor, w: &Tensor, b: &Tensor, activation: Activation) -> Result<Tensor> {
    x.apply_op3(w, b, Linear { activation })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ops::gradient_check::{check, variable};

    #[test]
    fn gradients_agree_with_finite_differences() {
        let (x, w, b) = (variable(1, &[7, 5]), variable(2, &[5, 4]), variable(3, &[4]));
        check(&[&x, &w, &b], || linear_biased(&x, &w, &b, Activation::Identity));
        check(&[&x, &w], || linear(&x, &w, Activation::Identity));
        // A smooth point of the ReLU: keep pre-activations away from zero.
        let far = (b.as_tensor() * 0.0).and_then(|b| b + 9.0).expect("a bias");
        b.set(&far).expect("set");
        check(&[&x, &w, &b], || linear_biased(&x, &w, &b, Activation::Relu));
        assert!(linear(&w, &w, Activation::Relu).is_err());
    }

    #[test]
    fn the_rectifier_stops_values_and_gradients() {
        let (x, w) = (variable(1, &[1, 1]), variable(2, &[1, 1]));
        x.set(&Tensor::new(&[[-2.0f32]], x.device()).expect("x")).expect("set");
        w.set(&Tensor::new(&[[3.0f32]], x.device()).expect("w")).expect("set");
        let y = linear(&x, &w, Activation::Relu).expect("y");
        assert_eq!(y.to_vec2::<f32>().expect("numbers"), [[0.0]]);
        let gradient = y.backward().expect("gradients").get(&w).expect("w").to_vec2::<f32>();
        assert_eq!(gradient.expect("numbers"), [[0.0]]);
    }
}
