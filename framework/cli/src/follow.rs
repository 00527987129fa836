//! Paths of poses followed on one branch of the arm.

use seeone_core::Pose;
use seeone_core::random::{generator, uniform};
use seeone_core::robot::RobotModel;
use seeone_plugin::{Clearance, Contact, IkQuery, IkStatus, Kinematics, PluginError};

/// Time from one pose to the next, seconds: 125 Hz.
pub const PERIOD_S: f64 = 0.008;
/// A posture further off its pose than this does not follow, metres and radians.
const TOLERANCE_M: f64 = 2e-5;
const TOLERANCE_RAD: f64 = 1e-4;
/// Branches tried beside the one nearest to home.
const BRANCHES: usize = 40;
/// Postures nearer than this are one branch, radians.
const SAME_RAD: f64 = 0.1;

/// How far a path could be followed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Followed {
    /// A posture for each pose followed, radians.
    pub joints: Vec<Vec<f64>>,
    /// Why no further.
    pub reason: Option<String>,
    /// What the arm touches first on the way, and at which pose.
    pub contact: Option<(usize, Contact)>,
}

impl Followed {
    /// Followed further is better, then touching nothing for longer.
    fn rank(&self) -> (usize, usize) {
        (self.joints.len(), self.contact.as_ref().map_or(usize::MAX, |(at, _)| *at))
    }
}

/// Follows paths for one robot.
pub struct Follower<'a> {
    /// The robot.
    pub robot: &'a RobotModel,
    /// Solves for joints.
    pub kinematics: &'a dyn Kinematics,
    /// What to keep away from.
    pub clearance: &'a dyn Clearance,
    /// Seed of the branches tried.
    pub seed: u64,
}

impl Follower<'_> {
    /// Follows a path of tool poses in `world` on the branch nearest to home, or, where that
    /// ends or touches something, on the best of the others.
    ///
    /// # Errors
    /// When the kinematics cannot work on it.
    pub fn follow(&self, poses: &[Pose]) -> Result<Followed, PluginError> {
        let mut rng = generator(self.seed, "branches");
        let joints = self.robot.joints();
        let middle = joints.iter().map(|j| 0.5 * (j.lower() + j.upper())).collect();
        let mut draw = || joints.iter().map(|j| uniform(&mut rng, j.lower(), j.upper())).collect();
        let nears = [self.robot.home().to_vec(), middle].into_iter();
        let nears: Vec<Vec<f64>> = nears.chain((0..BRANCHES).map(|_| draw())).collect();
        let mut tried: Vec<Vec<f64>> = Vec::new();
        let mut best = Followed::default();
        for near in nears {
            let first = self.kinematics.solve(self.robot, &IkQuery::new(&poses[0], &near))?;
            if first.status != IkStatus::Solved {
                if tried.is_empty() {
                    best.reason = first.reason;
                }
                continue;
            }
            let same =
                |q: &Vec<f64>| q.iter().zip(&first.joints).all(|(a, b)| (a - b).abs() < SAME_RAD);
            if tried.iter().any(same) {
                continue;
            }
            let followed = self.branch(poses, &first.joints)?;
            if tried.is_empty() || followed.rank() > best.rank() {
                best = followed;
            }
            if best.rank() == (poses.len(), usize::MAX) {
                break;
            }
            tried.push(first.joints);
        }
        Ok(best)
    }

    /// Follows the path on the branch of `first`, a posture at the first pose.
    fn branch(&self, poses: &[Pose], first: &[f64]) -> Result<Followed, PluginError> {
        let mut followed = Followed::default();
        let mut at = first.to_vec();
        for (index, pose) in poses.iter().enumerate() {
            let query = IkQuery {
                // The branch's first posture is where the path begins, not a period before it.
                period_s: (index > 0).then_some(PERIOD_S),
                ..IkQuery::continuous(pose, &at)
            };
            let found = self.kinematics.solve(self.robot, &query)?;
            let (off_m, off_rad) = (found.position_error_m, found.rotation_error_rad);
            if off_m > TOLERANCE_M || off_rad > TOLERANCE_RAD {
                let why = found.reason.unwrap_or_else(|| {
                    format!("{:.3} mm and {:.3} mrad off with the joints at their largest speed or limit", 1e3 * off_m, 1e3 * off_rad)
                });
                followed.reason = Some(format!("pose {index}: {why}"));
                break;
            }
            if followed.contact.is_none() {
                followed.contact = self.clearance.contact(&found.joints).map(|c| (index, c));
            }
            at.clone_from(&found.joints);
            followed.joints.push(found.joints);
        }
        Ok(followed)
    }
}
