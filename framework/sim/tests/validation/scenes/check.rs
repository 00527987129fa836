//! A measured quantity beside its analytic value.

use std::fmt::{self, Display, Formatter};

/// One line of the validation table.
#[derive(Clone, Debug)]
pub struct Check {
    quantity: String,
    formula: &'static str,
    unit: &'static str,
    expected: f64,
    measured: f64,
    /// What a deviation of 1 is, in the unit of the quantity.
    scale: f64,
    bar: f64,
}

impl Check {
    /// `measured` shall be within the share `bar` of `expected`, both in `unit`.
    pub fn share(
        quantity: impl Into<String>,
        formula: &'static str,
        unit: &'static str,
        (expected, measured): (f64, f64),
        bar: f64,
    ) -> Self {
        let (quantity, scale) = (quantity.into(), expected.abs());
        Self { quantity, formula, unit, expected, measured, scale, bar }
    }

    /// `measured` shall be at most `bar`, both in `unit`; zero is right.
    pub fn at_most(
        quantity: impl Into<String>,
        formula: &'static str,
        unit: &'static str,
        measured: f64,
        bar: f64,
    ) -> Self {
        let (quantity, scale, expected) = (quantity.into(), 1.0, 0.0);
        Self { quantity, formula, unit, expected, measured, scale, bar }
    }

    /// The deviation in terms of the bar.
    pub fn deviation(&self) -> f64 {
        (self.measured - self.expected).abs() / self.scale
    }

    /// Whether the bar is met.
    pub fn holds(&self) -> bool {
        self.deviation() <= self.bar
    }
}

/// A row of a Markdown table.
impl Display for Check {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { quantity, formula, unit, expected, measured, bar, .. } = self;
        let verdict = if self.holds() { "met" } else { "**missed**" };
        let (expected, measured) = (figures(*expected), figures(*measured));
        write!(f, "| {quantity} | {formula} | {expected} | {measured} {unit} | ")?;
        write!(f, "{} | {} | {verdict} |", figures(self.deviation()), figures(*bar))
    }
}

/// Three significant figures.
fn figures(value: f64) -> String {
    if value == 0.0 {
        return "0".into();
    }
    let digits = 2 - value.abs().log10().floor() as i32;
    if (0..=5).contains(&digits) {
        format!("{value:.*}", digits as usize)
    } else {
        format!("{value:.1e}")
    }
}
