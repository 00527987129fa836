//! Fused set abstraction (PointNet++, Qi et al. 2017): gather, first layer, second layer
//! and maximum over the neighbourhood, without ever storing a grouped tensor.
//!
//! The first layer of a neighbour `j` of centre `m`, `W [f_j, x_j - x_m] + b`, is split
//! into `h_j = W_f f_j + W_x x_j + b` and `c_m = W_x x_m`, computed once a point instead of
//! once a neighbour. The maximum selects one neighbour for each output, so the backward
//! pass touches one row a neighbourhood and output instead of all of them.

use super::{cpu_slice, grad_vec, matrix_shape, storage_slice};
use crate::matmul::{Matrix, MatrixMut, Store, multiply};
use candle_core::{CpuStorage, CustomOp3, Layout, Result, Shape, Tensor, bail};
use seeone_core::vectorize::vectorize;
use std::sync::{Mutex, PoisonError};

/// Centres whose grouped rows fit in the second-level cache together.
const CENTRES_AT_ONCE: usize = 16;

/// Which points belong to each centre: `size` rows each, repeated where there are fewer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Neighborhoods {
    /// Rows of the stacked points, `size` for each centre in turn.
    pub rows: Vec<u32>,
    /// Points in one neighbourhood.
    pub size: usize,
}

struct SetAbstraction {
    neighborhoods: Neighborhoods,
    /// For each centre and output, the point that won the maximum.
    winners: Mutex<Vec<u32>>,
}

/// `relu(h - c)` of one neighbour.
#[inline(always)]
fn rectified(h: &[f32], c: &[f32], out: &mut [f32]) {
    for ((o, h), c) in out.iter_mut().zip(h).zip(c) {
        *o = (h - c).max(0.0);
    }
}

impl CustomOp3 for SetAbstraction {
    fn name(&self) -> &'static str {
        "set_abstraction"
    }

    fn cpu_fwd(
        &self,
        h: &CpuStorage,
        hl: &Layout,
        c: &CpuStorage,
        cl: &Layout,
        w: &CpuStorage,
        wl: &Layout,
    ) -> Result<(CpuStorage, Shape)> {
        let ((points, hidden), (centres, hidden_c), (hidden_w, outputs)) =
            (matrix_shape(hl)?, matrix_shape(cl)?, matrix_shape(wl)?);
        let Neighborhoods { rows, size } = &self.neighborhoods;
        if hidden != hidden_c || hidden != hidden_w || hidden == 0 || outputs == 0 {
            bail!("set abstraction: hidden sizes {hidden}, {hidden_c} and {hidden_w}");
        }
        if *size == 0 || rows.len() != centres * size || rows.iter().any(|r| *r as usize >= points)
        {
            bail!(
                "set abstraction: the neighbourhoods do not fit {points} points, {centres} centres"
            );
        }
        let (h, c, w) = (cpu_slice(h, hl)?, cpu_slice(c, cl)?, cpu_slice(w, wl)?);
        let mut y = vec![f32::NEG_INFINITY; centres * outputs];
        let mut winners = vec![0u32; centres * outputs];
        let mut grouped = vec![0.0f32; CENTRES_AT_ONCE * size * hidden];
        let mut lifted = vec![0.0f32; CENTRES_AT_ONCE * size * outputs];
        for first in (0..centres).step_by(CENTRES_AT_ONCE) {
            let tile = first..centres.min(first + CENTRES_AT_ONCE);
            let count = tile.len() * size;
            vectorize(
                #[inline(always)]
                || {
                    for (i, row) in rows[tile.start * size..tile.end * size].iter().enumerate() {
                        let centre = &c[(first + i / size) * hidden..][..hidden];
                        let point = &h[*row as usize * hidden..][..hidden];
                        rectified(point, centre, &mut grouped[i * hidden..][..hidden]);
                    }
                },
            );
            multiply(
                MatrixMut::new(&mut lifted, count, outputs),
                Matrix::new(&grouped, count, hidden),
                Matrix::new(w, hidden, outputs),
                Store::Replace,
            );
            vectorize(
                #[inline(always)]
                || {
                    for centre in tile.clone() {
                        let best = &mut y[centre * outputs..][..outputs];
                        let winner = &mut winners[centre * outputs..][..outputs];
                        for k in 0..*size {
                            let row = rows[centre * size + k];
                            let values =
                                &lifted[((centre - first) * size + k) * outputs..][..outputs];
                            for ((b, n), v) in best.iter_mut().zip(winner.iter_mut()).zip(values) {
                                *n = if *v > *b { row } else { *n };
                                *b = if *v > *b { *v } else { *b };
                            }
                        }
                    }
                },
            );
        }
        *self.winners.lock().unwrap_or_else(PoisonError::into_inner) = winners;
        Ok((CpuStorage::F32(y), Shape::from((centres, outputs))))
    }

    fn bwd(
        &self,
        h: &Tensor,
        c: &Tensor,
        w: &Tensor,
        _y: &Tensor,
        gradient: &Tensor,
    ) -> Result<(Option<Tensor>, Option<Tensor>, Option<Tensor>)> {
        let ((points, hidden), (centres, _), (_, outputs)) = (h.dims2()?, c.dims2()?, w.dims2()?);
        let dy = grad_vec(gradient)?;
        let (h_storage, h_layout) = h.storage_and_layout();
        let (c_storage, c_layout) = c.storage_and_layout();
        let (h_values, c_values) =
            (storage_slice(&h_storage, h_layout)?, storage_slice(&c_storage, c_layout)?);
        // Columns of W as rows: both inner loops then run along memory.
        let columns = grad_vec(&w.t()?)?;
        let mut dcolumns = vec![0.0f32; outputs * hidden];
        let (mut dh, mut dc) = (vec![0.0f32; points * hidden], vec![0.0f32; centres * hidden]);
        let winners = self.winners.lock().unwrap_or_else(PoisonError::into_inner);
        vectorize(
            #[inline(always)]
            || {
                for centre in 0..centres {
                    let c_row = &c_values[centre * hidden..][..hidden];
                    let dc_row = &mut dc[centre * hidden..][..hidden];
                    for output in 0..outputs {
                        let g = dy[centre * outputs + output];
                        let row = winners[centre * outputs + output] as usize;
                        let h_row = &h_values[row * hidden..][..hidden];
                        let dh_row = &mut dh[row * hidden..][..hidden];
                        let column = &columns[output * hidden..][..hidden];
                        let dcolumn = &mut dcolumns[output * hidden..][..hidden];
                        for i in 0..hidden {
                            let a = h_row[i] - c_row[i];
                            let d = if a > 0.0 { g * column[i] } else { 0.0 };
                            dcolumn[i] += g * a.max(0.0);
                            dh_row[i] += d;
                            dc_row[i] -= d;
                        }
                    }
                }
            },
        );
        let device = h.device();
        Ok((
            Some(Tensor::from_vec(dh, (points, hidden), device)?),
            Some(Tensor::from_vec(dc, (centres, hidden), device)?),
            Some(Tensor::from_vec(dcolumns, (outputs, hidden), device)?.t()?.contiguous()?),
        ))
    }
}

/// `max_k relu(h[k] - c) W` over each neighbourhood.
///
/// `h`: points x hidden, `c`: centres x hidden, `w`: hidden x outputs; the result is
/// centres x outputs. Ties go to the neighbour named first, in both directions.
///
/// # Errors
/// When shapes or the table do not agree.
pub fn set_abstraction(
    h: &Tensor,
    c: &Tensor,
    w: &Tensor,
    neighborhoods: Neighborhoods,
) -> Result<Tensor> {
    h.apply_op3(c, w, SetAbstraction { neighborhoods, winners: Mutex::new(Vec::new()) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ops::gradient_check::{check, variable};

    #[test]
    fn agrees_with_the_composed_operations_in_value_and_gradient() {
        let (h, c, w) = (variable(1, &[9, 6]), variable(2, &[20, 6]), variable(3, &[6, 5]));
        let rows: Vec<u32> = (0..20 * 3).map(|i| (i * 7 % 9) as u32).collect();
        let fused = || set_abstraction(&h, &c, &w, Neighborhoods { rows: rows.clone(), size: 3 });
        let composed = || {
            let index = Tensor::from_vec(rows.clone(), 60, h.device())?;
            let grouped = h.index_select(&index, 0)?.reshape((20, 3, 6))?;
            let lifted =
                grouped.broadcast_sub(&c.unsqueeze(1)?)?.relu()?.reshape((60, 6))?.matmul(&w)?;
            lifted.reshape((20, 3, 5))?.max(1)
        };
        let (a, b) = (fused().expect("fused"), composed().expect("composed"));
        let probe = variable(4, &[20, 5]);
        let gradients = |y: &Tensor| {
            (y * probe.as_tensor()).and_then(|l| l.sum_all()?.backward()).expect("gradients")
        };
        let distance = |a: &Tensor, b: &Tensor| {
            (a - b)
                .and_then(|d| d.abs()?.flatten_all()?.max(0)?.to_scalar::<f32>())
                .expect("a number")
        };
        assert!(distance(&a, &b) < 1e-5);
        let (ga, gb) = (gradients(&a), gradients(&b));
        for var in [&h, &c, &w] {
            assert!(distance(ga.get(var).expect("fused"), gb.get(var).expect("composed")) < 1e-4);
        }
    }

    #[test]
    fn the_weights_gradient_agrees_with_finite_differences() {
        let (h, c, w) = (variable(5, &[6, 4]), variable(6, &[4, 4]), variable(7, &[4, 3]));
        let rows = vec![0, 1, 2, 3, 4, 5, 1, 3];
        check(&[&w], || set_abstraction(&h, &c, &w, Neighborhoods { rows: rows.clone(), size: 2 }));
        assert!(set_abstraction(&h, &c, &w, Neighborhoods { rows, size: 3 }).is_err());
    }
}
