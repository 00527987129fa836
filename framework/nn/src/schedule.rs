//! The learning rate over a training.

/// Share of the training in which the rate rises linearly.
const WARM_UP: f64 = 0.05;
/// Share of the training after which the rate begins to fall.
const FLAT_UNTIL: f64 = 0.30;

/// Factor of the peak rate at `progress` in `[0, 1]`: a linear rise, a flat part, then half
/// a cosine down to zero. Half of the accuracy arrives in the fall, so it is never cut off.
pub fn rate_factor(progress: f64) -> f64 {
    if progress < WARM_UP {
        progress / WARM_UP
    } else if progress < FLAT_UNTIL {
        1.0
    } else {
        let fall = ((progress - FLAT_UNTIL) / (1.0 - FLAT_UNTIL)).min(1.0);
        0.5 * (1.0 + (std::f64::consts::PI * fall).cos())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rises_stays_and_falls_to_zero_without_a_jump() {
        assert_eq!((rate_factor(0.0), rate_factor(0.2)), (0.0, 1.0));
        assert!(rate_factor(1.0).abs() < 1e-12);
        let jump = |a: f64| (rate_factor(a - 1e-9) - rate_factor(a + 1e-9)).abs();
        assert!(jump(WARM_UP) < 1e-6 && jump(FLAT_UNTIL) < 1e-6);
    }
}
