//! A rate with its interval.

use serde::Serialize;

/// The normal quantile of a two-sided 95 % interval.
const Z: f64 = 1.959_963_984_540_054;

/// Successes out of attempts with the 95 % Wilson score interval (Wilson 1927).
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Rate {
    /// How often it succeeded.
    pub successes: u64,
    /// How often it was tried.
    pub attempts: u64,
    /// Lower end of the interval, in `[0, 1]`.
    pub low: f64,
    /// Upper end of the interval, in `[0, 1]`.
    pub high: f64,
}

impl Rate {
    /// The rate of `true` among the outcomes.
    pub fn of(outcomes: impl IntoIterator<Item = bool>) -> Self {
        let (mut successes, mut attempts) = (0, 0);
        for success in outcomes {
            attempts += 1;
            successes += u64::from(success);
        }
        let (low, high) = wilson(successes, attempts);
        Self { successes, attempts, low, high }
    }

    /// In short: `34/40`.
    pub fn short(&self) -> String {
        format!("{}/{}", self.successes, self.attempts)
    }

    /// As a table shows it: `34/40 = 85.0 % (70.9 - 92.9)`.
    pub fn text(&self) -> String {
        format!(
            "{} = {:.1} % ({:.1} - {:.1})",
            self.short(),
            100.0 * self.successes as f64 / self.attempts.max(1) as f64,
            100.0 * self.low,
            100.0 * self.high
        )
    }
}

fn wilson(successes: u64, attempts: u64) -> (f64, f64) {
    if attempts == 0 {
        return (0.0, 1.0);
    }
    let (k, n) = (successes as f64, attempts as f64);
    let p = k / n;
    let spread = 1.0 + Z * Z / n;
    let centre = (p + Z * Z / (2.0 * n)) / spread;
    let half = Z / spread * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
    ((centre - half).max(0.0), (centre + half).min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Reference values by the formula in Wilson's paper, worked by hand for 34 of 40.
    #[test]
    fn agrees_with_the_formula_worked_by_hand() {
        let rate = Rate::of((0..40).map(|i| i < 34));
        assert!((rate.low - 0.7093).abs() < 5e-4, "{rate:?}");
        assert!((rate.high - 0.9294).abs() < 5e-4, "{rate:?}");
        assert_eq!(rate.text(), "34/40 = 85.0 % (70.9 - 92.9)");
    }

    #[test]
    fn stays_within_zero_and_one() {
        assert_eq!(Rate::of([]).text(), "0/0 = 0.0 % (0.0 - 100.0)");
        assert_eq!(Rate::of([true; 20]).high, 1.0);
        assert_eq!(Rate::of([false; 20]).low, 0.0);
    }
}
