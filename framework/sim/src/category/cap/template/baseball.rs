//! Baseball caps.
//!
//! Real ones measure 95 to 135 mm from hem to apex and have visors of 65 to 80 mm over 55 to
//! 70 degrees to each side, flat or bent by up to 35 mm. The ranges are widened a little, so
//! that what is learnt on them also holds for caps that this generator did not make.

use super::{BrimPattern, Pattern, StrapHole};
use crate::category::cap::shape::{Range, Shape};
use std::f64::consts::TAU;

pub const PATTERN: Pattern = Pattern {
    open: 0.0,
    brim: BrimPattern::Front { reach: 2.0 / 11.0, rows: 1.0 },
    strap_hole: Some(StrapHole { half_angle: 0.42, height: 2.6 / 11.0 }),
};

pub const RANGES: Shape<Range> = Shape {
    circumference: (0.537, 0.554),
    oval: (0.75, 0.84),
    egg: (-0.03, 0.04),
    height: (0.088, 0.130),
    apex_exponent: (1.7, 2.5),
    wall_exponent: (2.0, 3.3),
    front_structure: (0.0, 1.2),
    apex_forward: (-0.012, 0.016),
    apex_right: (-0.005, 0.005),
    overhang: (0.0, 0.0),
    front_lift: (0.0, 0.014),
    hem_tilt: (-0.002, 0.012),
    panel_flatness: (0.0, 0.035),
    unevenness: (0.0, 0.02),
    phase: (0.0, TAU),
    button: (0.0, 0.004),
    band: (0.0, 0.0),
    strap_hole: (0.026, 0.038),
    brim_length: (0.055, 0.088),
    brim_half_angle: (0.90, 1.30),
    brim_squareness: (1.9, 3.8),
    brim_forwardness: (0.1, 0.9),
    brim_slope: (0.05, 0.45),
    brim_side_drop: (0.0, 0.035),
    brim_tip_drop: (0.0, 0.008),
    crown_density: (0.50, 0.64),
    brim_density: (0.85, 1.25),
    crown_bending_exponent: (-4.7, -3.7),
    brim_bending_exponent: (-1.3, -0.52),
    softness_hz: (4.0, 5.5),
};
