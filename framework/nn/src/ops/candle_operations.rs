//! candle's own operations that networks here rely on, held to the same test as ours: some
//! of its gradients are wrong.

use super::gradient_check::{check, variable};
use candle_core::{D, Tensor};

#[test]
fn sums_products_and_reductions() {
    let (a, b) = (variable(1, &[4, 6]), variable(2, &[4, 6]));
    check(&[&a, &b], || (a.as_tensor() + b.as_tensor())? * a.as_tensor());
    check(&[&a], || a.sqr()?.mean_all());
    check(&[&a], || a.sum(0));
    let row = variable(3, &[6]);
    check(&[&a, &row], || a.broadcast_sub(&row)?.broadcast_mul(&row));
}

#[test]
fn products_of_matrices_and_softmax() {
    let (a, b) = (variable(4, &[2, 3, 5]), variable(5, &[2, 5, 4]));
    check(&[&a, &b], || {
        let logits = a.matmul(&b)?;
        let shifted = logits.broadcast_sub(&logits.max_keepdim(D::Minus1)?.detach())?.exp()?;
        shifted.broadcast_div(&shifted.sum_keepdim(D::Minus1)?)
    });
}

#[test]
fn pieces_of_tensors() {
    let (a, b) = (variable(6, &[4, 6]), variable(7, &[4, 3]));
    check(&[&a, &b], || Tensor::cat(&[a.as_tensor(), b.as_tensor()], 1)?.narrow(1, 4, 4));
    check(&[&a], || a.t()?.contiguous()?.reshape((8, 3)));
    let index = Tensor::new(&[3u32, 0, 0, 2, 3], a.device()).expect("an index");
    check(&[&a], || a.index_select(&index, 0));
}

#[test]
fn absolute_values_away_from_zero() {
    let a = variable(8, &[5, 5]);
    let away =
        (a.sign().expect("signs") * 5.0).and_then(|s| &a.as_tensor().clone() + s).expect("sum");
    a.set(&away).expect("set");
    check(&[&a], || a.abs());
}
