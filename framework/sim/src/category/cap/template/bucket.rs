//! Bucket hats: a flat top and a soft brim that falls all round.

use super::{BrimPattern, Pattern};
use crate::category::cap::shape::{Range, Shape};
use std::f64::consts::TAU;

pub const PATTERN: Pattern =
    Pattern { open: 0.0, brim: BrimPattern::Round { rows: 0.6 }, strap_hole: None };

pub const RANGES: Shape<Range> = Shape {
    circumference: (0.532, 0.560),
    oval: (0.85, 0.97),
    egg: (-0.02, 0.02),
    height: (0.088, 0.115),
    apex_exponent: (2.4, 4.0),
    wall_exponent: (2.4, 4.0),
    front_structure: (0.0, 0.0),
    apex_forward: (-0.006, 0.006),
    apex_right: (-0.005, 0.005),
    overhang: (0.0, 0.0),
    front_lift: (0.0, 0.0),
    hem_tilt: (-0.004, 0.004),
    panel_flatness: (0.0, 0.03),
    unevenness: (0.0, 0.02),
    phase: (0.0, TAU),
    button: (0.0, 0.0),
    band: (0.0, 0.0),
    strap_hole: (0.0, 0.0),
    brim_length: (0.045, 0.075),
    brim_half_angle: (0.0, 0.0),
    brim_squareness: (0.0, 0.0),
    brim_forwardness: (0.0, 0.0),
    brim_slope: (0.35, 1.05),
    brim_side_drop: (0.0, 0.0),
    brim_tip_drop: (-0.006, 0.006),
    crown_density: (0.45, 0.58),
    brim_density: (0.5, 0.7),
    crown_bending_exponent: (-4.3, -3.3),
    brim_bending_exponent: (-3.3, -2.3),
    softness_hz: (4.0, 5.5),
};
