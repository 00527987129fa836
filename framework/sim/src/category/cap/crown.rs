//! The crown: a hexagonal disc mapped to a dome.
//!
//! Ring `k` of the disc has `6 k` vertices, so that no edge near the apex is shorter than
//! at the hem, as it would be in a polar grid, and six natural panels appear.

use super::resolution::{Resolution, first_of_ring};
use super::shape::Shape;
use nalgebra::{Point3, Vector3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Steps of the table that turns arc length into a place on the profile.
const ARC_STEPS: usize = 240;

/// Angle of hem vertex `j` about z: 0 is the front (+y), growing towards the left (-x).
pub fn hem_angle(resolution: Resolution, j: isize) -> f64 {
    TAU * j as f64 / resolution.hem() as f64
}

/// A triangle of the disc.
pub struct Facet {
    /// Its vertices, counter-clockwise from above.
    pub triangle: [u32; 3],
    /// The ring on its outer side, counted from 1.
    pub ring: usize,
    /// Its panel: the sixth of the disc in which it lies, counted from the front towards
    /// the left. Panels 0 and 5 meet at the front seam.
    pub panel: usize,
}

/// The triangles of the disc.
pub fn facets(resolution: Resolution) -> Vec<Facet> {
    let mut all = Vec::new();
    for ring in 1..=resolution.rings() {
        let outer = |i: usize| (first_of_ring(ring) + i % (6 * ring)) as u32;
        let inner = |i: usize| (first_of_ring(ring - 1) + i % (6 * (ring - 1)).max(1)) as u32;
        for panel in 0..6 {
            for i in 0..ring {
                let (o, n) = (panel * ring + i, panel * (ring - 1) + i);
                all.push(Facet { triangle: [outer(o), outer(o + 1), inner(n)], ring, panel });
                if i + 1 < ring {
                    let triangle = [outer(o + 1), inner(n + 1), inner(n)];
                    all.push(Facet { triangle, ring, panel });
                }
            }
        }
    }
    all
}

/// The vertices of the dome in metres, ring by ring.
pub fn vertices(shape: &Shape, resolution: Resolution) -> Vec<Point3<f64>> {
    let rings = resolution.rings();
    let scale = hem_scale(shape, resolution);
    let mut all = Vec::with_capacity(first_of_ring(rings + 1));
    for ring in 0..=rings {
        for i in 0..(6 * ring).max(1) {
            let angle = TAU * i as f64 / (6 * ring).max(1) as f64;
            all.push(dome_point(shape, scale, ring as f64 / rings as f64, angle));
        }
    }
    all[0].z += shape.button;
    all
}

/// The hem's outline in the horizontal plane at `angle`, before it is scaled to length.
fn oval(shape: &Shape, angle: f64) -> Vector3<f64> {
    let (s, c) = angle.sin_cos();
    Vector3::new(-s * shape.oval * (1.0 - shape.egg * c), c, 0.0)
}

/// Metres per unit of [`oval`] that give the hem its circumference.
fn hem_scale(shape: &Shape, resolution: Resolution) -> f64 {
    let point = |j| oval(shape, hem_angle(resolution, j));
    let around: f64 =
        (0..resolution.hem() as isize).map(|j| (point(j + 1) - point(j)).norm()).sum();
    shape.circumference / around
}

/// Height of the hem at `angle`: raised in front, tilted towards the back.
fn hem_height(shape: &Shape, angle: f64) -> f64 {
    let from_front = (angle + PI).rem_euclid(TAU) - PI;
    let lifted = shape.front_lift * (-(from_front / 0.7).powi(2)).exp();
    lifted + shape.hem_tilt * 0.5 * (angle.cos() - 1.0)
}

fn dome_point(shape: &Shape, scale: f64, arc: f64, angle: f64) -> Point3<f64> {
    let hem = oval(shape, angle) * scale;
    let bottom = hem_height(shape, angle);
    let rise = shape.height - bottom;
    let (radius, height) = on_profile(shape, angle, rise / hem.norm(), arc);
    let flat = 1.0 - shape.panel_flatness * (3.0 * angle).sin().abs() * (PI * arc).sin();
    let wave = (2.0 * angle + shape.phase).cos() + (3.0 * angle - 2.0 * shape.phase).cos();
    let uneven = 1.0 + shape.unevenness * wave * (PI * arc).sin();
    let lean = Vector3::new(shape.apex_right, shape.apex_forward, 0.0) * height;
    let xy = hem * (radius * flat * uneven) + lean;
    Point3::new(xy.x, xy.y, bottom + rise * height)
}

/// Radius and height (hem = (1, 0), apex = (0, 1)) at the fraction `arc` of the profile's
/// length from the apex. The profile is `radius^p + height^q = 1`; `aspect` is its rise
/// over its radius.
fn on_profile(shape: &Shape, angle: f64, aspect: f64, arc: f64) -> (f64, f64) {
    let frontness = (0.5 + 0.5 * angle.cos()).powi(2);
    let p = shape.apex_exponent;
    let q = shape.wall_exponent + shape.front_structure * frontness;
    let place = |step: usize| {
        let (s, c) = (FRAC_PI_2 * step as f64 / ARC_STEPS as f64).sin_cos();
        (s.powf(2.0 / p), c.max(0.0).powf(2.0 / q))
    };
    let length = |a: (f64, f64), b: (f64, f64)| (b.0 - a.0).hypot((b.1 - a.1) * aspect);
    let total: f64 = (0..ARC_STEPS).map(|i| length(place(i), place(i + 1))).sum();
    let mut left = arc * total;
    for i in 0..ARC_STEPS {
        let (a, b) = (place(i), place(i + 1));
        let step = length(a, b);
        if left <= step {
            let t = left / step;
            return (a.0 + (b.0 - a.0) * t, a.1 + (b.1 - a.1) * t);
        }
        left -= step;
    }
    (1.0, 0.0)
}
