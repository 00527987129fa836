//! What tells one cap from another: the parameters of its shape and its fabric.

use rand::seq::SliceRandom;
use seeone_core::random::{Generator, generator, uniform};

/// The parameters of one cap. Ranges and their meaning stand in [`RANGES`], in this order;
/// the sources of the design ranges are measured headwear, widened so that what is learnt
/// on them also holds for caps that this generator did not make.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// Length of the hem in metres.
    pub circumference: f64,
    /// Breadth of the hem oval over its length.
    pub oval: f64,
    /// How much fuller the oval is behind than in front, relative to its breadth.
    pub egg: f64,
    /// Height of the apex over the hem plane in metres.
    pub height: f64,
    /// Exponent of the crown's profile at the apex: below 2 pointed, above 2 flat.
    pub apex_exponent: f64,
    /// Exponent of the crown's profile at the hem: above 2 the walls stand steep.
    pub wall_exponent: f64,
    /// Added to `wall_exponent` in front: the stiffened panels stand up.
    pub front_structure: f64,
    /// How far the apex lies in front of the hem's centre, metres.
    pub apex_forward: f64,
    /// How far the apex lies to the right, metres: no cap is symmetric.
    pub apex_right: f64,
    /// How far the hem rises in the middle of the front, metres.
    pub front_lift: f64,
    /// How far the hem's back lies under its front, metres.
    pub hem_tilt: f64,
    /// How flat the panels lie between their seams, relative to the radius.
    pub panel_flatness: f64,
    /// Amplitude of the crown's smooth irregularities, relative to the radius.
    pub unevenness: f64,
    /// Phase of the irregularities, radians.
    pub phase: f64,
    /// Height of the button, metres.
    pub button: f64,
    /// Length of the brim in front, metres.
    pub brim_length: f64,
    /// Half of the angle of the hem that carries the brim, radians.
    pub brim_half_angle: f64,
    /// Exponent of the brim's outline: 2 round, 4 square.
    pub brim_squareness: f64,
    /// Direction in which the brim grows: 0 away from the hem, 1 straight forward.
    pub brim_forwardness: f64,
    /// Fall of the brim along its length, radians.
    pub brim_slope: f64,
    /// How far the brim's sides hang below its middle, metres.
    pub brim_side_drop: f64,
    /// How far the brim's tip bends down in addition to its slope, metres.
    pub brim_tip_drop: f64,
    /// Half width of the strap hole in the back, metres; none below 0.02.
    pub strap_hole: f64,
    /// Area density of crown and brim, kg/m2.
    pub density: [f64; 2],
    /// Bending stiffness of the crown's fabric as a power of ten, N m.
    pub bending_exponent: f64,
    /// Frequency with which the whole cap returns to its shape, hertz.
    pub softness_hz: f64,
}

/// Number of parameters.
pub const PARAMETERS: usize = 27;

/// Smallest and largest value of every parameter, in the order of [`Shape`]'s fields.
pub const RANGES: [(f64, f64); PARAMETERS] = [
    (0.528, 0.560),               // circumference
    (0.75, 0.84),                 // oval
    (-0.03, 0.04),                // egg
    (0.088, 0.130),               // height
    (1.7, 2.5),                   // apex_exponent
    (2.0, 3.3),                   // wall_exponent
    (0.0, 1.2),                   // front_structure
    (-0.012, 0.016),              // apex_forward
    (-0.005, 0.005),              // apex_right
    (0.0, 0.014),                 // front_lift
    (-0.002, 0.012),              // hem_tilt
    (0.0, 0.035),                 // panel_flatness
    (0.0, 0.02),                  // unevenness
    (0.0, std::f64::consts::TAU), // phase
    (0.0, 0.004),                 // button
    (0.055, 0.088),               // brim_length
    (0.90, 1.30),                 // brim_half_angle
    (1.9, 3.8),                   // brim_squareness
    (0.1, 0.9),                   // brim_forwardness
    (0.05, 0.45),                 // brim_slope
    (0.0, 0.035),                 // brim_side_drop
    (0.0, 0.008),                 // brim_tip_drop
    (0.0, 0.034),                 // strap_hole
    (0.46, 0.58),                 // crown density
    (0.65, 0.95),                 // brim density
    (-4.7, -3.5),                 // bending_exponent
    (4.0, 5.5),                   // softness_hz
];

impl Shape {
    fn from_values(v: [f64; PARAMETERS]) -> Self {
        Self {
            circumference: v[0],
            oval: v[1],
            egg: v[2],
            height: v[3],
            apex_exponent: v[4],
            wall_exponent: v[5],
            front_structure: v[6],
            apex_forward: v[7],
            apex_right: v[8],
            front_lift: v[9],
            hem_tilt: v[10],
            panel_flatness: v[11],
            unevenness: v[12],
            phase: v[13],
            button: v[14],
            brim_length: v[15],
            brim_half_angle: v[16],
            brim_squareness: v[17],
            brim_forwardness: v[18],
            brim_slope: v[19],
            brim_side_drop: v[20],
            brim_tip_drop: v[21],
            strap_hole: v[22],
            density: [v[23], v[24]],
            bending_exponent: v[25],
            softness_hz: v[26],
        }
    }
}

/// `count` shapes as a Latin hypercube: each parameter takes every one of `count` equal
/// slices of its range exactly once (McKay, Beckman and Conover 1979).
pub fn latin_hypercube(count: usize, seed: u64, stream: &str) -> Vec<Shape> {
    let mut rng = generator(seed, stream);
    let columns: Vec<Vec<f64>> = RANGES.iter().map(|r| stratified(count, *r, &mut rng)).collect();
    (0..count).map(|i| Shape::from_values(std::array::from_fn(|p| columns[p][i]))).collect()
}

fn stratified(count: usize, (low, high): (f64, f64), rng: &mut Generator) -> Vec<f64> {
    let slice = (high - low) / count as f64;
    let mut values: Vec<f64> =
        (0..count).map(|i| low + slice * (i as f64 + uniform(rng, 0.0, 1.0))).collect();
    values.shuffle(rng);
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_slice_of_a_parameter_is_taken_once() {
        let shapes = latin_hypercube(20, 3, "test");
        let (low, high) = RANGES[15];
        let mut slices: Vec<usize> =
            shapes.iter().map(|s| ((s.brim_length - low) / (high - low) * 20.0) as usize).collect();
        slices.sort_unstable();
        assert_eq!(slices, (0..20).collect::<Vec<_>>());
    }
}
