//! A smooth curve through closely spaced postures.

/// The natural cubic spline through equally spaced postures: its acceleration has no steps, so
/// that a smooth run along it needs no jerk without bound.
pub(crate) struct Spline<'a> {
    path: &'a [Vec<f64>],
    /// Second derivatives at the postures, a posture's spacing being one.
    bends: Vec<Vec<f64>>,
}

impl<'a> Spline<'a> {
    /// Through `path`, at least one posture.
    pub(crate) fn through(path: &'a [Vec<f64>]) -> Self {
        let mut bends = vec![vec![0.0; path[0].len()]; path.len()];
        let inner = 1..path.len().saturating_sub(1);
        // Bends satisfy b[k-1] + 4 b[k] + b[k+1] = 6 (q[k-1] - 2 q[k] + q[k+1]), zero at both
        // ends: eliminated downwards, then solved upwards (Thomas).
        let mut scale = vec![0.0; path.len()];
        for k in inner.clone() {
            scale[k] = 1.0 / (4.0 - scale[k - 1]);
            let (before, here) = bends.split_at_mut(k);
            for (i, bend) in here[0].iter_mut().enumerate() {
                let second = path[k - 1][i] - 2.0 * path[k][i] + path[k + 1][i];
                *bend = (6.0 * second - before[k - 1][i]) * scale[k];
            }
        }
        for k in inner.rev() {
            let (here, after) = bends.split_at_mut(k + 1);
            for (bend, next) in here[k].iter_mut().zip(&after[0]) {
                *bend -= scale[k] * next;
            }
        }
        Self { path, bends }
    }

    /// The posture `u` of the way along, in 0..=1.
    pub(crate) fn at(&self, u: f64) -> Vec<f64> {
        let last = self.path.len() - 1;
        if last == 0 {
            return self.path[0].clone();
        }
        let along = (u * last as f64).clamp(0.0, last as f64);
        let k = (along.floor() as usize).min(last - 1);
        let (after, before) = (along - k as f64, (k + 1) as f64 - along);
        let cubic = |share: f64| (share * share * share - share) / 6.0;
        (0..self.path[k].len())
            .map(|i| {
                before * self.path[k][i]
                    + after * self.path[k + 1][i]
                    + cubic(before) * self.bends[k][i]
                    + cubic(after) * self.bends[k + 1][i]
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn goes_through_its_postures_without_a_step_in_slope_or_bend() {
        let path: Vec<Vec<f64>> = (0..12)
            .map(|k| vec![(0.3 * f64::from(k)).sin(), f64::from(k).powi(2) * 0.01])
            .collect();
        let spline = Spline::through(&path);
        for (k, posture) in path.iter().enumerate() {
            let there = spline.at(k as f64 / 11.0);
            assert!(there.iter().zip(posture).all(|(a, b)| (a - b).abs() < 1e-12));
        }
        let step = 1e-4;
        let slope = |u: f64, i: usize| (spline.at(u + step)[i] - spline.at(u)[i]) / step;
        let bend = |u: f64, i: usize| (slope(u + step, i) - slope(u, i)) / step;
        for k in 1..11 {
            let knot = f64::from(k) / 11.0;
            for i in 0..2 {
                assert!((slope(knot, i) - slope(knot - step, i)).abs() < 0.01);
                assert!((bend(knot, i) - bend(knot - 2.0 * step, i)).abs() < 0.1, "{k} {i}");
            }
        }
    }

    #[test]
    fn between_postures_it_is_where_a_smooth_curve_is() {
        let curve = |u: f64| (2.0 * u).sin();
        let path: Vec<Vec<f64>> = (0..=40).map(|k| vec![curve(f64::from(k) / 40.0)]).collect();
        let spline = Spline::through(&path);
        for k in 100..900 {
            let u = f64::from(k) / 1000.0;
            assert!((spline.at(u)[0] - curve(u)).abs() < 1e-6);
        }
        assert_eq!(Spline::through(&path[..1]).at(0.7), path[0]);
    }
}
