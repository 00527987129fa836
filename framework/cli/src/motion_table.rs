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
