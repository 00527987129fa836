//! The rules of kind `kinematics`.

use super::arm::arm;
use super::violation::{Violation, answered, hold, refused, sound};
use crate::{IkOutcome, IkQuery, IkStatus, Kinematics};
use seeone_core::Pose;
use seeone_core::pose::difference;
use seeone_core::random::{generator, uniform};
use seeone_core::robot::RobotModel;

/// The worst that counts as solved: metres and radians.
const SOLVED: (f64, f64) = (1e-3, 0.01);
/// How far the errors that are told may be from the true ones.
const HONEST: f64 = 1e-6;

/// Holds every rule of the kind.
///
/// # Errors
/// The first rule that `plugin` breaks.
pub fn kinematics(plugin: &dyn Kinematics) -> Result<(), Violation> {
    let robot = arm();
    reaches_what_is_near(plugin, &robot)?;
    says_what_is_out_of_reach(plugin, &robot)?;
    refuses_what_is_wrong(plugin, &robot)
}

fn reaches_what_is_near(plugin: &dyn Kinematics, robot: &RobotModel) -> Result<(), Violation> {
    let mut rng = generator(0, "conformance-kinematics");
    for round in 0..20 {
        let mut draw = |reach: f64| uniform(&mut rng, -reach, reach);
        let posture: Vec<f64> = robot.home().iter().map(|q| q + draw(0.6)).collect();
        let near: Vec<f64> = posture.iter().map(|q| q + draw(0.05)).collect();
        let target = robot.tool_pose(&posture);
        for query in [IkQuery::new(&target, &near), IkQuery::continuous(&target, &near)] {
            let rule = "what is near is reached";
            let found = answered(rule, || plugin.solve(robot, &query))?;
            let told = || format!("round {round}: {found:?}");
            hold(rule, found.status == IkStatus::Solved, told)?;
            honest(robot, &target, &found)?;
            let rule = "the same input gives the same bytes";
            let again = answered(rule, || plugin.solve(robot, &query))?;
            hold(rule, format!("{found:?}") == format!("{again:?}"), told)?;
        }
    }
    Ok(())
}

/// Whether an outcome says what its joints do.
fn honest(robot: &RobotModel, target: &Pose, found: &IkOutcome) -> Result<(), Violation> {
    sound("finite in, finite and within the limits out", found.check(robot))?;
    let (metres, radians) = difference(&robot.tool_pose(&found.joints), target);
    let rule = "the errors that are told are those of the joints";
    let near = (found.position_error_m - metres).abs() < HONEST
        && (found.rotation_error_rad - radians).abs() < HONEST;
    hold(rule, near, || format!("{metres:.2e} m and {radians:.2e} rad, {found:?}"))?;
    let within = metres <= SOLVED.0 && radians <= SOLVED.1;
    let claimed = found.status == IkStatus::Solved;
    let rule = "solved is within 1 mm and 0.01 rad";
    hold(rule, within || !claimed, || format!("{found:?}"))
}

fn says_what_is_out_of_reach(plugin: &dyn Kinematics, robot: &RobotModel) -> Result<(), Violation> {
    let rule = "what is out of reach is infeasible, with a reason";
    let target = Pose::translation(10.0, 0.0, 0.5);
    let found = answered(rule, || plugin.solve(robot, &IkQuery::new(&target, robot.home())))?;
    let said = found.status == IkStatus::Infeasible && found.reason.is_some();
    hold(rule, said, || format!("{found:?}"))?;
    honest(robot, &target, &found)
}

fn refuses_what_is_wrong(plugin: &dyn Kinematics, robot: &RobotModel) -> Result<(), Violation> {
    let target = robot.tool_pose(robot.home());
    let from = |near: &[f64]| plugin.solve(robot, &IkQuery::new(&target, near));
    for length in [0, 1, robot.joints().len() + 1] {
        refused("a start of another length is refused", || from(&vec![0.1; length]))?;
    }
    let mut near = robot.home().to_vec();
    near[2] = f64::NAN;
    refused("a start that is not finite is refused", || from(&near))?;
    near[2] = 9.0;
    refused("a start outside the limits is refused", || from(&near))?;
    let nowhere = Pose::translation(f64::NAN, 0.0, 0.0);
    let ask = || plugin.solve(robot, &IkQuery::new(&nowhere, robot.home()));
    refused("a pose that is not finite is refused", ask)
}
