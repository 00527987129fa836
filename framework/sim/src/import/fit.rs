//! Where the hem of an upright cap lies, which way the brim points, and how large it is.

use super::ImportFault;
use super::sheet::Sheet;
use nalgebra::{Matrix3, Point2, Point3, Rotation3, Vector3};
use std::collections::BTreeSet;
use std::f64::consts::{FRAC_PI_2, TAU};

/// What lies lower than this share of the height may belong to the brim.
const LOW: f64 = 0.45;
/// A side that reaches this much farther than the median one carries the brim.
const BRIM_REACH: f64 = 1.15;
/// A front found this near to an axis of the file is meant to be on it, radians.
const SNAP_RAD: f64 = 0.17;
/// A section longer than this relative to its breadth contains the brim.
const LONGEST_OVAL: f64 = 1.5;
/// Sections are taken from this share of the height downwards, in steps of this share.
const HIGHEST: f64 = 0.6;
const STEP: f64 = 0.02;
/// A front that comes forward this much more than it goes down is a brim.
const BRIM_FALL: f64 = 1.3;
/// Directions in which a section is looked for around its middle, and how many must be
/// filled: a strap hole may open the back.
const SECTORS: usize = 12;
const FILLED_SECTORS: usize = 9;

/// The crown's outline just above the hem, in the frame of the sheet.
#[derive(Clone, Copy, Debug)]
pub struct Hem {
    /// Its middle at its height.
    pub centre: Point3<f64>,
    /// Half of its breadth (x).
    pub half_breadth: f64,
    /// Half of its length (y).
    pub half_length: f64,
    /// Length of the line around it.
    pub circumference: f64,
}

impl Hem {
    /// Goes down the crown, section by section, until the front runs out into the brim or
    /// the outline opens.
    ///
    /// # Errors
    /// [`ImportFault::NotACap`] when there is no crown to go down.
    pub fn find(sheet: &Sheet) -> Result<Self, ImportFault> {
        let (low, high) = sheet.bounds();
        let step = STEP * (high.z - low.z);
        let mut lowest: Option<Self> = None;
        for i in 0..(HIGHEST / STEP) as usize {
            let z = low.z + HIGHEST * (high.z - low.z) - i as f64 * step;
            let Some(next) = Self::at(sheet, z) else { break };
            if lowest.is_some_and(|last| next.front() - last.front() > BRIM_FALL * step) {
                break;
            }
            lowest = Some(next);
        }
        lowest.ok_or(ImportFault::NotACap("no section of it looks like a crown"))
    }

    fn front(&self) -> f64 {
        self.centre.y + self.half_length
    }

    fn at(sheet: &Sheet, z: f64) -> Option<Self> {
        let outline = convex_hull(section(sheet, z));
        let span = |pick: fn(&Point2<f64>) -> f64| {
            let low = outline.iter().map(pick).fold(f64::INFINITY, f64::min);
            (low, outline.iter().map(pick).fold(f64::NEG_INFINITY, f64::max))
        };
        let (x, y) = (span(|p| p.x), span(|p| p.y));
        let (half_breadth, half_length) = ((x.1 - x.0) / 2.0, (y.1 - y.0) / 2.0);
        let centre = Point3::new((x.0 + x.1) / 2.0, (y.0 + y.1) / 2.0, z);
        let sectors: BTreeSet<usize> = section(sheet, z)
            .iter()
            .map(|p| sector((p.y - centre.y).atan2(p.x - centre.x), SECTORS))
            .collect();
        let oval = half_length < LONGEST_OVAL * half_breadth && half_breadth < 1.3 * half_length;
        (outline.len() > 2 && oval && sectors.len() >= FILLED_SECTORS).then(|| {
            let circumference = length_around(&outline);
            Self { centre, half_breadth, half_length, circumference }
        })
    }

    /// Horizontal distance of `p` from the middle in units of the oval: 1 is on it.
    pub fn reach(&self, p: &Point3<f64>) -> f64 {
        let (x, y) = (p.x - self.centre.x, p.y - self.centre.y);
        (x / self.half_breadth).hypot(y / self.half_length)
    }
}

/// Turns an upright sheet about z until the side that reaches farthest lies at +y.
///
/// # Errors
/// [`ImportFault::NotACap`] when no side stands out.
pub fn turn_front_to_y(sheet: &mut Sheet) -> Result<(), ImportFault> {
    const SIDES: usize = 72;
    let (low, high) = sheet.bounds();
    let limit = low.z + LOW * (high.z - low.z);
    let (crown, area) = (0..sheet.triangles.len())
        .map(|i| (sheet.centre(i), sheet.normal(i).norm()))
        .filter(|(c, _)| c.z > limit)
        .fold((Vector3::zeros(), 0.0), |(sum, area), (c, a)| (sum + c.coords * a, area + a));
    let middle = crown / area.max(f64::MIN_POSITIVE);
    let mut reach = [0.0f64; SIDES];
    for v in sheet.vertices.iter().filter(|v| v.z < limit) {
        let (x, y) = (v.x - middle.x, v.y - middle.y);
        let side = &mut reach[sector(y.atan2(x), SIDES)];
        *side = side.max(x.hypot(y));
    }
    let mut sorted = reach;
    sorted.sort_by(f64::total_cmp);
    let usual = sorted[SIDES / 2] * BRIM_REACH;
    let pull = reach.iter().enumerate().fold(Vector3::zeros(), |sum, (i, r)| {
        let angle = (i as f64 + 0.5) * TAU / SIDES as f64;
        sum + Vector3::new(angle.cos(), angle.sin(), 0.0) * (r - usual).max(0.0)
    });
    if pull.norm() < 0.05 * usual {
        return Err(ImportFault::NotACap("no brim stands out on any side"));
    }
    let mut angle = pull.y.atan2(pull.x);
    let axis = (angle / FRAC_PI_2).round() * FRAC_PI_2;
    if (angle - axis).abs() < SNAP_RAD {
        angle = axis;
    }
    let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), FRAC_PI_2 - angle);
    sheet.vertices.iter_mut().for_each(|v| *v = turn * *v);
    Ok(())
}

/// Scales the sheet so that the section above its hem gets this circumference.
///
/// # Errors
/// [`ImportFault::NotACap`] when it has no hem.
pub fn scale_to_hem(sheet: &mut Sheet, circumference_m: f64) -> Result<(), ImportFault> {
    let scale = circumference_m / Hem::find(sheet)?.circumference;
    sheet.vertices.iter_mut().for_each(|v| v.coords *= scale);
    Ok(())
}

/// Scales the sheet so that the rim itself, the line through the vertices `rim`, gets this
/// circumference, and moves the rim's middle to the origin. The rim need not lie level.
pub fn fit_rim(sheet: &mut Sheet, rim: &BTreeSet<u32>, circumference_m: f64) {
    let points: Vec<Vector3<f64>> =
        rim.iter().map(|v| sheet.vertices[*v as usize].coords).collect();
    let middle = points.iter().sum::<Vector3<f64>>() / points.len().max(1) as f64;
    let spread: Matrix3<f64> = points.iter().map(|p| (p - middle) * (p - middle).transpose()).sum();
    let eigen = spread.symmetric_eigen();
    let [u, v] = [eigen.eigenvectors.column(eigen.eigenvalues.imax()).into_owned(), {
        let normal = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned();
        normal.cross(&eigen.eigenvectors.column(eigen.eigenvalues.imax()))
    }];
    let flat = points.iter().map(|p| Point2::new((p - middle).dot(&u), (p - middle).dot(&v)));
    let around = length_around(&convex_hull(flat.collect()));
    let (low, high) = points.iter().fold((points[0], points[0]), |(l, h), p| (l.inf(p), h.sup(p)));
    let scale = circumference_m / around;
    let centre = (low + high) / 2.0;
    sheet.vertices.iter_mut().for_each(|v| *v = Point3::from((v.coords - centre) * scale));
}

/// Length of a closed line.
fn length_around(outline: &[Point2<f64>]) -> f64 {
    let next = outline.iter().cycle().skip(1);
    outline.iter().zip(next).map(|(a, b)| (b - a).norm()).sum()
}

/// Which of `count` equal sectors of the circle an angle falls into.
fn sector(angle: f64, count: usize) -> usize {
    ((angle.rem_euclid(TAU) / TAU * count as f64) as usize).min(count - 1)
}

/// Where the edges of the sheet cross the plane at height `z`.
fn section(sheet: &Sheet, z: f64) -> Vec<Point2<f64>> {
    let mut points = Vec::new();
    for t in &sheet.triangles {
        for i in 0..3 {
            let a = sheet.vertices[t[i] as usize];
            let b = sheet.vertices[t[(i + 1) % 3] as usize];
            if (a.z < z) != (b.z < z) {
                points.push((a + (b - a) * ((z - a.z) / (b.z - a.z))).xy());
            }
        }
    }
    points
}

/// The convex hull, counter-clockwise (Andrew 1979).
fn convex_hull(mut points: Vec<Point2<f64>>) -> Vec<Point2<f64>> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    let half = |points: &mut dyn Iterator<Item = &Point2<f64>>| {
        let mut chain: Vec<Point2<f64>> = Vec::new();
        for p in points {
            while let [.., a, b] = chain.as_slice()
                && (b - a).perp(&(p - a)) <= 0.0
            {
                chain.pop();
            }
            chain.push(*p);
        }
        chain.pop();
        chain
    };
    let mut hull = half(&mut points.iter());
    hull.extend(half(&mut points.iter().rev()));
    hull
}
