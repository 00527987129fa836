//! How far the parameters of a template reach.

use super::shape::{Range, Shape};

/// Which ranges shapes are drawn from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Breadth {
    /// The template's own: what caps of the category look like.
    Usual,
    /// Wider by 35 % at both ends. Networks that were trained on these too meet the caps
    /// of the category, and those of another hand, as something between what they know.
    Wide,
}

/// Part of a parameter's range that is added at each end.
const MARGIN: f64 = 0.35;

impl Breadth {
    /// The ranges of this breadth, from a template's own. Fabric stays what it is, and so does
    /// the hem, which has to fit a head.
    pub fn of(self, usual: &Shape<Range>) -> Shape<Range> {
        match self {
            Self::Usual => *usual,
            Self::Wide => Shape {
                circumference: usual.circumference,
                oval: usual.oval,
                egg: usual.egg,
                front_lift: usual.front_lift,
                hem_tilt: usual.hem_tilt,
                phase: usual.phase,
                crown_density: usual.crown_density,
                brim_density: usual.brim_density,
                crown_bending_exponent: usual.crown_bending_exponent,
                brim_bending_exponent: usual.brim_bending_exponent,
                softness_hz: usual.softness_hz,
                ..usual.map(widened)
            },
        }
    }
}

/// A range with its margins; what is never negative stays so.
fn widened(&(low, high): &Range) -> Range {
    let margin = MARGIN * (high - low);
    let lowest = if low >= 0.0 { 0.0 } else { f64::NEG_INFINITY };
    ((low - margin).max(lowest), high + margin)
}
