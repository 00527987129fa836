//! Sun visors: a band of 35 to 45 mm, open at the top, with a large visor.

use super::{BrimPattern, Pattern};
use crate::category::cap::shape::{Range, Shape};
use std::f64::consts::TAU;

pub const PATTERN: Pattern = Pattern {
    open: 7.0 / 11.0,
    brim: BrimPattern::Front { reach: 15.0 / 66.0, rows: 1.0 },
    strap_hole: None,
};

pub const RANGES: Shape<Range> = Shape {
    circumference: (0.520, 0.544),
    oval: (0.77, 0.87),
    egg: (-0.03, 0.04),
    height: (0.095, 0.125),
    apex_exponent: (1.8, 2.4),
    wall_exponent: (2.0, 2.8),
    front_structure: (0.0, 0.6),
    apex_forward: (-0.008, 0.008),
    apex_right: (-0.003, 0.003),
    overhang: (0.0, 0.0),
    front_lift: (0.0, 0.010),
    hem_tilt: (-0.002, 0.010),
    panel_flatness: (0.0, 0.01),
    unevenness: (0.0, 0.01),
    phase: (0.0, TAU),
    button: (0.0, 0.0),
    band: (0.035, 0.045),
    strap_hole: (0.0, 0.0),
    brim_length: (0.065, 0.095),
    brim_half_angle: (1.22, 1.75),
    brim_squareness: (1.9, 3.2),
    brim_forwardness: (0.2, 0.8),
    brim_slope: (0.05, 0.50),
    brim_side_drop: (0.0, 0.025),
    brim_tip_drop: (0.0, 0.008),
    crown_density: (0.70, 0.90),
    brim_density: (0.55, 0.80),
    crown_bending_exponent: (-4.7, -4.0),
    brim_bending_exponent: (-1.69, -0.7),
    softness_hz: (4.0, 5.5),
};
