//! All solutions of an arm whose joints 2, 3 and 4 are parallel and whose last two axes
//! meet, as in every UR: products of exponentials and Paden-Kahan subproblems (Murray,
//! Li and Sastry 1994, chapter 3). The geometry is read off the robot model.

use crate::subproblem::{between, projecting, reaching, turn};
use nalgebra::{Point3, UnitQuaternion, UnitVector3, Vector3};
use seeone_core::Pose;
use seeone_core::robot::RobotModel;

/// By how much parallel axes may deviate, radians, and axes that meet may miss each
/// other, metres: a factory calibration stays below, and the descent that follows mends
/// what is left.
const AXIS_TOLERANCE: f64 = 0.02;
const MEETING_TOLERANCE_M: f64 = 0.003;
/// By how much a distance may be out of reach and still be taken as stretched out (metres at
/// the shoulder, square metres in the arm, where squares are compared, unitless at the wrist):
/// rounding, where the geometry is exact, and else what a calibration makes of it.
const EXACT_SLACK: f64 = 1e-6;
const CALIBRATED_SLACK: f64 = 1e-2;
/// Axes that are this parallel, and meet this nearly, are so exactly.
const EXACT: f64 = 1e-9;

/// The geometry of a six-joint arm of the UR's structure, at zero position in `world`.
#[derive(Clone, Debug, PartialEq)]
pub struct ClosedForm {
    axes: [UnitVector3<f64>; 6],
    /// `+1` or `-1`: whether joints 2, 3, 4 turn with or against the second axis.
    senses: [f64; 3],
    /// A point on axis 1.
    shoulder: Point3<f64>,
    /// From axis 1 to 2, 2 to 3, 3 to 4 and from there to where axes 5 and 6 meet.
    offsets: [Vector3<f64>; 4],
    /// Where axes 5 and 6 meet, in the tool frame.
    wrist_in_tool: Point3<f64>,
    tool_rotation: UnitQuaternion<f64>,
    slack: f64,
}

impl ClosedForm {
    /// The geometry of `robot`, if it has the structure.
    pub fn of(robot: &RobotModel) -> Option<Self> {
        let joints = robot.joints();
        if joints.len() != 6 {
            return None;
        }
        let zero = [0.0; 6];
        let links = robot.forward(&zero);
        let axis = |i: usize| links[i + 1].rotation * joints[i].axis();
        let axes: [_; 6] = std::array::from_fn(axis);
        let point = |i: usize| Point3::from(links[i + 1].translation.vector);
        let parallel = |i: usize| axes[1].cross(&axes[i]).norm() < AXIS_TOLERANCE;
        let crossing = |i: usize, j: usize| axes[i].cross(&axes[j]).norm() > 0.1;
        if !(parallel(2) && parallel(3) && crossing(0, 1) && crossing(3, 4) && crossing(4, 5)) {
            return None;
        }
        let (wrist, miss) = meeting_point(&point(4), &axes[4], &point(5), &axes[5]);
        if miss > MEETING_TOLERANCE_M {
            return None;
        }
        let skew = (2..4).map(|i| axes[1].cross(&axes[i]).norm()).fold(miss, f64::max);
        let tool = robot.tool_pose(&zero);
        Some(Self {
            axes,
            senses: [1.0, axes[1].dot(&axes[2]).signum(), axes[1].dot(&axes[3]).signum()],
            shoulder: point(0),
            offsets: [
                point(1) - point(0),
                point(2) - point(1),
                point(3) - point(2),
                wrist - point(3),
            ],
            wrist_in_tool: tool.inverse() * wrist,
            tool_rotation: tool.rotation,
            slack: if skew < EXACT { EXACT_SLACK } else { CALIBRATED_SLACK },
        })
    }

    /// Every solution for the tool pose `target` in `world`, in radians without regard to
    /// whole turns and limits; at most eight. Where the last joint is free (wrist
    /// singularity) it takes `near`'s.
    pub fn solve(&self, target: &Pose, near: &[f64]) -> Vec<[f64; 6]> {
        let [h1, h2, _, _, h5, h6] = &self.axes;
        let wrist = self.wrist(target);
        // How the last link has turned since the zero position.
        let turned = target.rotation * self.tool_rotation.inverse();
        let along = self.sideways();
        let mut solutions = Vec::with_capacity(8);
        for q1 in projecting(h2, &back(h1), &wrist, along, self.slack) {
            let shoulder = UnitQuaternion::from_axis_angle(h1, q1);
            let second = shoulder * h2.into_inner();
            let onto = second.dot(&(turned * h6.into_inner()));
            for q5 in projecting(h2, h5, h6, onto, self.slack) {
                let wrist_two = UnitQuaternion::from_axis_angle(h5, q5);
                let from = turned.inverse() * second;
                let to = wrist_two.inverse() * h2.into_inner();
                let q6 = between(h6, &from, &to).unwrap_or(near[5]);
                let wrist_three = UnitQuaternion::from_axis_angle(h6, q6);
                let arm = shoulder.inverse() * turned * (wrist_two * wrist_three).inverse();
                let sideways = perpendicular(h2);
                let Some(q234) = between(h2, &sideways, &(arm * sideways)) else { continue };
                let reach =
                    shoulder.inverse() * wrist - self.offsets[0] - turn(h2, q234, &self.offsets[3]);
                self.elbows(&reach, |q2, q3| {
                    let q4 = q234 - q2 - q3;
                    let [s2, s3, s4] = self.senses;
                    solutions.push([q1, s2 * q2, s3 * q3, s4 * q4, q5, q6]);
                });
            }
        }
        solutions
    }

    /// By how much the wrist, for the tool pose `target` in `world`, would be nearer to the first
    /// axis than the arm can fold, metres; negative where it is further away.
    pub(crate) fn inside(&self, target: &Pose) -> f64 {
        self.sideways().abs() - self.wrist(target).cross(&self.axes[0]).norm()
    }

    /// From a point on axis 1 to where axes 5 and 6 meet.
    fn wrist(&self, target: &Pose) -> Vector3<f64> {
        target * self.wrist_in_tool - self.shoulder
    }

    /// How far the wrist is beside the plane that the upper arm and the forearm move in.
    fn sideways(&self) -> f64 {
        self.offsets.iter().map(|offset| self.axes[1].dot(offset)).sum()
    }

    /// Angles 2 and 3 about the second axis that bring the fourth to `reach`.
    fn elbows(&self, reach: &Vector3<f64>, mut found: impl FnMut(f64, f64)) {
        let h2 = &self.axes[1];
        let flat = |v: &Vector3<f64>| v - h2.into_inner() * h2.dot(v);
        let (upper, fore, reach) = (flat(&self.offsets[1]), flat(&self.offsets[2]), flat(reach));
        for q3 in reaching(h2, &upper, &fore, reach.norm(), self.slack) {
            let folded = upper + turn(h2, q3, &fore);
            found(between(h2, &folded, &reach).unwrap_or(0.0), q3);
        }
    }
}

fn back(axis: &UnitVector3<f64>) -> UnitVector3<f64> {
    UnitVector3::new_unchecked(-axis.into_inner())
}

/// A unit vector perpendicular to `axis`.
fn perpendicular(axis: &UnitVector3<f64>) -> Vector3<f64> {
    let least = axis.iamin();
    axis.cross(&Vector3::ith(least, 1.0)).normalize()
}

/// The middle of the shortest connection of two lines, and its length.
fn meeting_point(
    a: &Point3<f64>,
    along_a: &UnitVector3<f64>,
    b: &Point3<f64>,
    along_b: &UnitVector3<f64>,
) -> (Point3<f64>, f64) {
    let normal = along_a.cross(along_b);
    let between = b - a;
    let area = normal.norm_squared();
    let on_a = a + along_a.into_inner() * (between.cross(along_b).dot(&normal) / area);
    let on_b = b + along_b.into_inner() * (between.cross(along_a).dot(&normal) / area);
    (nalgebra::center(&on_a, &on_b), (on_b - on_a).norm())
}
