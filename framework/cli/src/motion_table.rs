//! The planned motion of a run as a table, for plots.

use seeone_core::robot::RobotModel;
use seeone_plugin::{Action, Program};
use std::fmt::Write;

/// CSV with a row a sample: seconds since the motion began without the time of grips, stage and
/// purpose, then of each joint the position in radians, and of each its speed since the sample
/// before as a share of the largest that it is built for.
pub fn table(robot: &RobotModel, program: &Program) -> String {
    let names = || robot.joints().iter().map(|joint| joint.name());
    let mut text = "time_s,stage,purpose".to_owned();
    for column in names().map(|n| format!("{n}_rad")).chain(names().map(|n| format!("{n}_speed"))) {
        // Writing into a text does not fail.
        let _ = write!(text, ",{column}");
    }
    text.push('\n');
    let mut began = 0.0;
    for step in &program.steps {
        let (Action::Move(trajectory) | Action::MoveUntilContact { trajectory, .. }) = &step.action
        else {
            continue;
        };
        let mut before = trajectory.positions.first();
        for (k, sample) in trajectory.positions.iter().enumerate() {
            let time = began + trajectory.period_s * k as f64;
            let _ = write!(text, "{time:.3},{},{}", step.stage, step.purpose);
            for q in sample {
                let _ = write!(text, ",{q:.6}");
            }
            let from = before.unwrap_or(sample);
            for (joint, (q, from)) in robot.joints().iter().zip(sample.iter().zip(from)) {
                let share = (q - from) / trajectory.period_s / joint.velocity();
                let _ = write!(text, ",{share:.4}");
            }
            text.push('\n');
            before = Some(sample);
        }
        began += trajectory.duration_s();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use seeone_core::robot::RobotOptions;
    use seeone_plugin::{GripperCommand, JointTrajectory, Step};
    use std::path::Path;

    #[test]
    fn a_row_a_sample_with_positions_and_shares_of_the_largest_speed() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/ur5-ag95.urdf");
        let robot = RobotModel::from_urdf(&file, &RobotOptions::default()).expect("the robot");
        let positions = vec![vec![0.0; 6], vec![0.0125, 0.0, 0.0, 0.0, 0.0, -0.025]];
        let trajectory = JointTrajectory { period_s: 0.008, positions };
        let step = |purpose, action| Step { stage: "pick".into(), purpose, action };
        let program = Program {
            steps: vec![
                step("transit", Action::Move(trajectory.clone())),
                step("grip", Action::Grip(GripperCommand::Close { force_n: 45.0 })),
                step("approach", Action::MoveUntilContact { trajectory, force_n: 10.0 }),
            ],
        };
        let text = table(&robot, &program);
        let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
        assert_eq!(rows.len(), 5);
        assert!(rows.iter().all(|row| row.len() == 15), "{text}");
        assert_eq!(rows[0][3..5], ["shoulder_pan_joint_rad", "shoulder_lift_joint_rad"]);
        assert_eq!((rows[0][9], rows[0][14]), ("shoulder_pan_joint_speed", "wrist_3_joint_speed"));
        // 0.0125 rad in 8 ms is 1.5625 rad/s of pi.
        assert_eq!((rows[2][0], rows[2][3], rows[2][9]), ("0.008", "0.012500", "0.4974"));
        assert_eq!((rows[2][8], rows[2][14]), ("-0.025000", "-0.9947"));
        assert_eq!(rows[3][..3], ["0.008", "pick", "approach"]);
    }
}
