//! G: the points at which features are asked for, rigidly attached to the gripper
//! (method: Eq. 7).

use nalgebra::Point3;

/// Sides of the box around the TCP, metres: across the pads, along the closing direction
/// from finger to finger, and along the approach.
const BOX_M: [f64; 3] = [0.024, 0.040, 0.036];
/// Points along each side; finest along the closing direction, where the surface is thin.
const POINTS: [usize; 3] = [4, 8, 4];

/// The 128 query points in the tool frame, metres: the cell centres of a lattice, the same
/// for every run.
pub fn gripper_points() -> Vec<Point3<f64>> {
    let at = |axis: usize, i: usize| BOX_M[axis] * ((i as f64 + 0.5) / POINTS[axis] as f64 - 0.5);
    let mut points = Vec::with_capacity(POINTS.iter().product());
    for x in 0..POINTS[0] {
        for y in 0..POINTS[1] {
            for z in 0..POINTS[2] {
                points.push(Point3::new(at(0, x), at(1, y), at(2, z)));
            }
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fills_the_box_around_the_tool_point() {
        let points = gripper_points();
        assert_eq!(points.len(), 128);
        let sum = points.iter().fold(0.0, |sum, p| sum + p.coords.norm());
        assert!(
            sum > 0.0
                && points
                    .iter()
                    .all(|p| { p.x.abs() < 0.012 && p.y.abs() < 0.020 && p.z.abs() < 0.018 })
        );
        let centre = points.iter().fold(nalgebra::Vector3::zeros(), |sum, p| sum + p.coords);
        assert!(centre.norm() < 1e-12);
    }
}
