//! Knitted caps: a tall, soft crown and no brim.

use super::{BrimPattern, Pattern};
use crate::category::cap::shape::{Range, Shape};
use std::f64::consts::TAU;

pub const PATTERN: Pattern = Pattern { open: 0.0, brim: BrimPattern::None, strap_hole: None };

pub const RANGES: Shape<Range> = Shape {
    circumference: (0.528, 0.552),
    oval: (0.90, 1.0),
    egg: (-0.01, 0.01),
    height: (0.150, 0.200),
    apex_exponent: (1.6, 2.2),
    wall_exponent: (2.2, 3.4),
    front_structure: (0.0, 0.0),
    apex_forward: (-0.008, 0.008),
    apex_right: (-0.008, 0.008),
    overhang: (0.0, 0.0),
    front_lift: (0.0, 0.0),
    hem_tilt: (-0.003, 0.003),
    panel_flatness: (0.0, 0.02),
    unevenness: (0.0, 0.03),
    phase: (0.0, TAU),
    button: (0.0, 0.0),
    band: (0.0, 0.0),
    strap_hole: (0.0, 0.0),
    brim_length: (0.0, 0.0),
    brim_half_angle: (0.0, 0.0),
    brim_squareness: (0.0, 0.0),
    brim_forwardness: (0.0, 0.0),
    brim_slope: (0.0, 0.0),
    brim_side_drop: (0.0, 0.0),
    brim_tip_drop: (0.0, 0.0),
    crown_density: (0.45, 0.60),
    brim_density: (0.5, 0.5),
    crown_bending_exponent: (-5.3, -4.3),
    brim_bending_exponent: (-4.0, -4.0),
    softness_hz: (4.0, 5.5),
};
