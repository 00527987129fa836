//! The crown: a hexagonal disc mapped to a dome.
//!
//! Ring `k` of the disc has `6 k` vertices, so that no edge near the apex is shorter than
//! at the hem, as it would be in a polar grid, and six natural panels appear.

use super::resolution::{Resolution, first_of_ring};
use super::shape::Shape;
use super::template::Pattern;
use super::warp::Warp;
use nalgebra::{Point3, Vector3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Steps of the table that turns arc length into a place on the profile.
const ARC_STEPS: usize = 96;

/// A triangle of the disc.
pub struct Facet {
    /// Its vertices, counter-clockwise from above.
    pub triangle: [u32; 3],
    /// The ring on its outer side, counted from 1.
    pub ring: usize,
    /// Its panel: the sixth of the disc in which it lies, counted from the front towards
    /// the left. Panels 0 and 5 meet at the front seam.
    pub panel: usize,
    /// Angle of its middle in the disc, 0 to 2 pi from the front towards the left.
    pub angle: f64,
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
                let facet = |triangle, at: f64, of: usize| Facet {
                    triangle,
                    ring,
                    panel,
                    angle: TAU * at / (6 * of) as f64,
                };
                all.push(facet([outer(o), outer(o + 1), inner(n)], o as f64 + 0.5, ring));
                if i + 1 < ring {
                    let triangle = [outer(o + 1), inner(n + 1), inner(n)];
                    all.push(facet(triangle, n as f64 + 0.5, ring - 1));
                }
            }
        }
    }
    all
}

/// The dome of one shape: a map from the disc to space.
pub struct Dome<'a> {
    shape: &'a Shape,
    pattern: &'a Pattern,
    resolution: Resolution,
    warp: Warp,
    /// Metres per unit of [`oval`].
    scale: f64,
}

impl<'a> Dome<'a> {
    /// The dome of `shape`, whose hem has the wanted length and whose brim and strap hole,
    /// where the pattern has them, end at the wanted angles.
    pub fn new(shape: &'a Shape, pattern: &'a Pattern, resolution: Resolution) -> Self {
        let length = |warp: Warp| -> f64 {
            let at = |j| oval(shape, warp.angle(hem_angle(resolution, j), 1.0));
            (0..resolution.hem() as isize).map(|j| (at(j + 1) - at(j)).norm()).sum()
        };
        let brim = pattern
            .front_reach(resolution)
            .map(|reach| [hem_angle(resolution, reach), shape.brim_half_angle]);
        let hole = pattern.strap_hole.as_ref().map(|hole| {
            let widest = shape.circumference / length(Warp::NONE) * shape.oval;
            [PI - hole.half_angle, PI - (shape.strap_hole / widest).asin()]
        });
        let warp = match (brim, hole) {
            (Some(brim), Some(hole)) => Warp::through_both(brim, hole),
            (Some(one), None) | (None, Some(one)) => Warp::through(one),
            (None, None) => Warp::NONE,
        };
        debug_assert!(warp.least_spacing() > 0.0, "the ranges keep the hem's vertices in order");
        Self { shape, pattern, resolution, warp, scale: shape.circumference / length(warp) }
    }

    /// Angle about z of hem vertex `j`: 0 is the front (+y), growing towards the left (-x).
    pub fn hem_angle(&self, j: isize) -> f64 {
        self.warp.angle(hem_angle(self.resolution, j), 1.0)
    }

    /// The vertices in metres, ring by ring. Rings above an open crown's band lie on its
    /// edge; no triangle uses them.
    pub fn vertices(&self) -> Vec<Point3<f64>> {
        let rings = self.resolution.rings();
        let open = self.pattern.first_ring(self.resolution);
        let mut all = Vec::with_capacity(first_of_ring(rings + 1));
        for ring in 0..=rings {
            let part = ring.saturating_sub(open) as f64 / (rings - open) as f64;
            for i in 0..(6 * ring).max(1) {
                let angle = TAU * i as f64 / (6 * ring).max(1) as f64;
                all.push(self.point(part, angle));
            }
        }
        if open == 0 {
            all[0].z += self.shape.button;
        }
        all
    }

    /// The point at `part` of the way from the crown's upper end to the hem, where the disc
    /// has the angle `u`.
    fn point(&self, part: f64, u: f64) -> Point3<f64> {
        let shape = self.shape;
        let angle = self.warp.angle(u, part);
        let hem = oval(shape, angle) * self.scale;
        let bottom = self.hem_height(angle);
        let rise = shape.height - bottom;
        let band = self.pattern.is_open().then_some(shape.band / hem.norm());
        let profile = Profile::new(shape, angle, rise / hem.norm());
        let (radius, height, arc) = profile.at(part, band);
        let flat = 1.0 - shape.panel_flatness * (3.0 * u).sin().abs() * (PI * arc).sin();
        let wave = (2.0 * angle + shape.phase).cos() + (3.0 * angle - 2.0 * shape.phase).cos();
        let uneven = 1.0 + shape.unevenness * wave * (PI * arc).sin();
        let lean = Vector3::new(shape.apex_right, shape.apex_forward, 0.0) * height;
        let bulge = shape.overhang * angle.cos().max(0.0).powi(2) * (PI * height.powf(0.6)).sin();
        let xy = hem * (radius * flat * uneven) + lean;
        Point3::new(xy.x, xy.y + bulge, bottom + rise * height)
    }

    /// Height of the hem at `angle`: raised in front, tilted towards the back.
    fn hem_height(&self, angle: f64) -> f64 {
        let from_front = (angle + PI).rem_euclid(TAU) - PI;
        let lifted = self.shape.front_lift * (-(from_front / 0.7).powi(2)).exp();
        lifted + self.shape.hem_tilt * 0.5 * (angle.cos() - 1.0)
    }
}

/// Angle of hem vertex `j` in the disc.
fn hem_angle(resolution: Resolution, j: isize) -> f64 {
    TAU * j as f64 / resolution.hem() as f64
}

/// The hem's outline in the horizontal plane at `angle`, before it is scaled to length.
fn oval(shape: &Shape, angle: f64) -> Vector3<f64> {
    let (s, c) = angle.sin_cos();
    Vector3::new(-s * shape.oval * (1.0 - shape.egg * c), c, 0.0)
}

/// The crown's profile at one angle, `radius^p + height^q = 1`, from the apex (0, 1) to the
/// hem (1, 0), as a polygon with its arc length in units of the hem's radius.
struct Profile {
    /// Radius, height and arc length from the apex.
    places: [[f64; 3]; ARC_STEPS + 1],
}

impl Profile {
    /// `aspect` is the rise over the hem's radius.
    fn new(shape: &Shape, angle: f64, aspect: f64) -> Self {
        let frontness = (0.5 + 0.5 * angle.cos()).powi(2);
        let p = shape.apex_exponent;
        let q = shape.wall_exponent + shape.front_structure * frontness;
        let mut places = [[0.0, 1.0, 0.0]; ARC_STEPS + 1];
        for i in 1..=ARC_STEPS {
            let (s, c) = (FRAC_PI_2 * i as f64 / ARC_STEPS as f64).sin_cos();
            let (radius, height) = (s.powf(2.0 / p), c.max(0.0).powf(2.0 / q));
            let [before, above, length] = places[i - 1];
            let step = (radius - before).hypot((height - above) * aspect);
            places[i] = [radius, height, length + step];
        }
        Self { places }
    }

    /// Radius, height and relative arc length at `part` of the way from the upper end to the
    /// hem. The upper end is the apex, or that of a `band` of this width (in hem radii).
    fn at(&self, part: f64, band: Option<f64>) -> (f64, f64, f64) {
        let total = self.places[ARC_STEPS][2];
        let start = band.map_or(0.0, |width| (total - width).max(0.0));
        let arc = start + part * (total - start);
        let above = self.places[..ARC_STEPS].partition_point(|place| place[2] < arc).max(1) - 1;
        let (a, b) = (self.places[above], self.places[above + 1]);
        let t = (arc - a[2]) / (b[2] - a[2]);
        (a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, arc / total)
    }
}
