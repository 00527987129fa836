//! Which pairs of a robot's links no collision check needs to look at, as the `[collision]` table
//! of its robot file: `cargo run --release -p seeone-collision --example pairs FILE.urdf`.

#![allow(clippy::print_stdout, reason = "the table is the answer")]

use seeone_collision::{SAMPLES, sampled};
use seeone_core::robot::{RobotModel, RobotOptions};
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let Some(file) = std::env::args().nth(1) else {
        println!("name a URDF");
        return ExitCode::from(2);
    };
    let robot = match RobotModel::from_urdf(Path::new(&file), &RobotOptions::default()) {
        Ok(robot) => robot,
        Err(fault) => {
            println!("{fault}");
            return ExitCode::from(2);
        }
    };
    let pairs = sampled(&robot, SAMPLES, 1);
    println!("[collision]");
    println!("always = {:?}", pairs.always);
    println!("never = {:?}", pairs.never);
    ExitCode::SUCCESS
}
