//! Laying the hand onto the surface that was seen: predicted coordinates are good to some
//! millimetres and their slope to some degrees, a visor is 3 mm thin, and the sensor knows
//! where it is to 2 mm.

use nalgebra::{Matrix3, Point3, Translation3, UnitQuaternion, Vector3};
use seeone_core::Pose;

/// Points this near to the tool's origin tell how the surface lies there, metres.
const PATCH_M: f64 = 0.022;
/// The least points that tell it.
const PATCH_POINTS: usize = 12;
/// The patch is wider than this (standard deviation) in its second direction, metres:
/// points along a line have no plane.
const PATCH_WIDTH_M: f64 = 0.003;
/// Points farther than so many standard deviations from the plane belong to something else.
const TRIM: f64 = 2.0;
/// A surface turned further than this from the predicted one is taken for another, radians.
const MOST_TURN_RAD: f64 = 0.7;
/// A surface farther than this from the predicted one is taken for another, metres.
const MOST_SHIFT_M: f64 = 0.02;

/// `tool` moved along and turned to the surface through the observed `points` (all in
/// `world`, metres) between its fingers, so that the sheet lies in the middle and flat
/// between the pads. `None` where too little was seen or it is not the predicted surface.
pub fn laid_on_surface(tool: &Pose, points: &[Point3<f64>]) -> Option<Pose> {
    let origin = Point3::from(tool.translation.vector);
    let closing = tool.rotation * Vector3::y();
    let near: Vec<Point3<f64>> =
        points.iter().filter(|p| (*p - origin).norm() < PATCH_M).copied().collect();
    let rough = Plane::through(&near)?;
    let kept: Vec<Point3<f64>> = near
        .into_iter()
        .filter(|p| rough.distance(p).abs() <= TRIM * rough.thickness_m.max(f64::EPSILON))
        .collect();
    let plane = Plane::through(&kept)?;
    let normal = if plane.normal.dot(&closing) < 0.0 { -plane.normal } else { plane.normal };
    let turn = UnitQuaternion::rotation_between(&closing, &normal)?;
    let shift = (plane.centre - origin).dot(&normal);
    if turn.angle() > MOST_TURN_RAD || shift.abs() > MOST_SHIFT_M {
        return None;
    }
    let place = Translation3::from(tool.translation.vector + normal * shift);
    Some(Pose::from_parts(place, turn * tool.rotation))
}

/// Half width across the hand, along its closing axis, and reach along its approach
/// (before and behind the tool's origin) of the strip in which an edge is looked for, metres.
const STRIP_M: [f64; 2] = [0.012, 0.008];
const REACH_M: [f64; 2] = [-0.045, 0.020];
/// The least points of a strip that show an edge.
const STRIP_POINTS: usize = 15;
/// Share of the strip's points that may lie beyond its edge: noise.
const BEYOND_EDGE: f64 = 0.03;
/// An edge farther than this from where it was shown is taken for another, metres.
const MOST_INSET_M: f64 = 0.025;

/// Where the sheet between the fingers ends towards the palm: its edge along the tool's z,
/// metres, negative behind the tool's origin. `None` where too little was seen.
pub fn edge_before_palm(tool: &Pose, points: &[Point3<f64>]) -> Option<f64> {
    let mut depths: Vec<f64> = points
        .iter()
        .map(|p| tool.inverse_transform_point(p))
        .filter(|q| q.x.abs() < STRIP_M[0] && q.y.abs() < STRIP_M[1])
        .filter(|q| (REACH_M[0]..REACH_M[1]).contains(&q.z))
        .map(|q| q.z)
        .collect();
    if depths.len() < STRIP_POINTS {
        return None;
    }
    depths.sort_by(f64::total_cmp);
    Some(depths[(BEYOND_EDGE * depths.len() as f64) as usize])
}

/// `tool` moved along its approach until the sheet's edge lies where the demonstration had
/// it, `shown_edge_m` along the tool's z; as it is where no edge was seen near there.
pub fn brought_to_edge(tool: &Pose, points: &[Point3<f64>], shown_edge_m: f64) -> Pose {
    let shift = edge_before_palm(tool, points).map_or(0.0, |edge| edge - shown_edge_m);
    let shift = if shift.abs() <= MOST_INSET_M { shift } else { 0.0 };
    tool * Translation3::new(0.0, 0.0, shift)
}

/// The plane nearest to some points.
struct Plane {
    centre: Point3<f64>,
    normal: Vector3<f64>,
    /// Standard deviation of the distances.
    thickness_m: f64,
}

impl Plane {
    fn through(points: &[Point3<f64>]) -> Option<Self> {
        if points.len() < PATCH_POINTS {
            return None;
        }
        let count = points.len() as f64;
        let mean = points.iter().map(|p| p.coords).sum::<Vector3<f64>>() / count;
        let scatter: Matrix3<f64> =
            points.iter().map(|p| (p.coords - mean) * (p.coords - mean).transpose() / count).sum();
        let eigen = scatter.symmetric_eigen();
        let mut order = [0, 1, 2];
        order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
        let [least, second, _] = order;
        if eigen.eigenvalues[second].max(0.0).sqrt() < PATCH_WIDTH_M {
            return None;
        }
        Some(Self {
            centre: Point3::from(mean),
            normal: eigen.eigenvectors.column(least).into(),
            thickness_m: eigen.eigenvalues[least].max(0.0).sqrt(),
        })
    }

    fn distance(&self, point: &Point3<f64>) -> f64 {
        (point - self.centre).dot(&self.normal)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square patch of 24 mm with its middle at `centre`, turned by `turn`.
    fn patch(centre: Vector3<f64>, turn: UnitQuaternion<f64>) -> Vec<Point3<f64>> {
        let at = |i: i32| f64::from(i) * 0.003;
        (-4..=4)
            .flat_map(|i| (-4..=4).map(move |k| Vector3::new(at(i), at(k), 0.0)))
            .map(|p| Point3::from(centre + turn * p))
            .collect()
    }

    fn tool() -> Pose {
        let z = Vector3::new(0.0, -1.0, 0.0);
        let rotation = seeone_core::pose::rotation_from_approach(&z, &Vector3::z());
        Pose::from_parts(Translation3::new(0.4, -0.2, 0.05), rotation)
    }

    #[test]
    fn lies_in_the_middle_and_flat_on_a_sloping_sheet() {
        let slope = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.4);
        let centre = Vector3::new(0.4, -0.2, 0.058);
        let laid = laid_on_surface(&tool(), &patch(centre, slope)).expect("seen");
        let normal = slope * Vector3::z();
        assert!((laid.rotation * Vector3::y() - normal).norm() < 1e-9);
        assert!((laid.translation.vector - centre).dot(&normal).abs() < 1e-9);
    }

    #[test]
    fn takes_the_sheet_as_far_in_as_was_shown() {
        let sheet = patch(Vector3::new(0.4, -0.2, 0.05), UnitQuaternion::identity());
        // The patch ends 12 mm behind the tool's origin; shown was 5 mm.
        let edge = edge_before_palm(&tool(), &sheet).expect("seen");
        assert!((edge + 0.012).abs() < 1e-9, "{edge}");
        let brought = brought_to_edge(&tool(), &sheet, -0.005);
        assert!((edge_before_palm(&brought, &sheet).expect("seen") + 0.005).abs() < 1e-9);
        assert_eq!(brought_to_edge(&tool(), &sheet[..9], -0.005), tool());
    }

    #[test]
    fn stays_where_too_little_or_something_else_was_seen() {
        let level = UnitQuaternion::identity();
        let centre = Vector3::new(0.4, -0.2, 0.05);
        assert!(laid_on_surface(&tool(), &patch(centre, level)[..11]).is_none());
        let steep = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 1.2);
        assert!(laid_on_surface(&tool(), &patch(centre, steep)).is_none());
        let line: Vec<_> =
            (0..20).map(|i| Point3::new(0.39 + f64::from(i) * 0.001, -0.2, 0.05)).collect();
        assert!(laid_on_surface(&tool(), &line).is_none());
    }
}
