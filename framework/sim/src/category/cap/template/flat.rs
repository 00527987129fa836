//! Flat caps: a low crown that leans forward over a short visor.

use super::{BrimPattern, Pattern};
use crate::category::cap::shape::{Range, Shape};
use std::f64::consts::TAU;

pub const PATTERN: Pattern = Pattern {
    open: 0.0,
    brim: BrimPattern::Front { reach: 10.0 / 66.0, rows: 0.6 },
    strap_hole: None,
};

pub const RANGES: Shape<Range> = Shape {
    circumference: (0.528, 0.556),
    oval: (0.76, 0.86),
    egg: (-0.03, 0.03),
    height: (0.084, 0.100),
    apex_exponent: (2.0, 3.0),
    wall_exponent: (2.0, 3.0),
    front_structure: (0.0, 0.0),
    apex_forward: (0.010, 0.030),
    apex_right: (-0.005, 0.005),
    overhang: (0.010, 0.030),
    front_lift: (0.0, 0.006),
    hem_tilt: (-0.002, 0.010),
    panel_flatness: (0.0, 0.02),
    unevenness: (0.0, 0.02),
    phase: (0.0, TAU),
    button: (0.0, 0.003),
    band: (0.0, 0.0),
    strap_hole: (0.0, 0.0),
    brim_length: (0.035, 0.055),
    brim_half_angle: (0.87, 1.05),
    brim_squareness: (1.9, 3.0),
    brim_forwardness: (0.2, 0.9),
    brim_slope: (0.15, 0.45),
    brim_side_drop: (0.010, 0.020),
    brim_tip_drop: (0.0, 0.006),
    crown_density: (0.60, 0.80),
    brim_density: (0.9, 1.4),
    crown_bending_exponent: (-4.3, -3.3),
    brim_bending_exponent: (-1.3, -0.7),
    softness_hz: (4.0, 5.5),
};
