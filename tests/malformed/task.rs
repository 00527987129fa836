//! Tasks: what `run` refuses, and what `check` says of them beside a robot and a scene.

use crate::support::{Bench, seeone};
use crate::{ROBOT, SCENE, SKILL, refused};

const TASK: &str = "skills/tasks/dress.toml";

fn run(bench: &Bench) -> crate::support::Call {
    let (task, out) = (bench.arg(TASK), bench.arg("out"));
    seeone([
        "run",
        &task,
        "--scene",
        &bench.arg(SCENE),
        "--robot",
        &bench.arg(ROBOT),
        "--out",
        &out,
    ])
}

#[test]
fn a_task_that_cannot_be_carried_out_is_refused_before_anything_moves() {
    let cases = [
        ("skill", "skill = \"cap-waering\"", "T024", "did you mean \"cap-wearing\"?"),
        ("tries", "tries = 0", "T020", "tries = 0"),
        ("tries", "object = \"cap-unseen-99\"", "O001", "did you mean \"cap-unseen-"),
        ("targets", "targets = { head = \"shelf\" }", "M005", "\"shelf\""),
        ("tries", "methods = { transfer = \"snapp\" }", "T024", "did you mean \"snap\"?"),
    ];
    for (start, line, code, cause) in cases {
        let bench = Bench::new();
        bench.set_line(TASK, start, line);
        refused(line, &bench, &run(&bench), code, &[cause]);
    }
}

#[test]
fn faults_of_a_tasks_skill_are_told_once_with_the_skills_place() {
    let bench = Bench::new();
    bench.append(TASK, "\n[[step]]\nname = \"again\"\nskill = \"cap-wearing\"\n");
    let line = bench.set_line(SKILL, "lift_m", "lift_m = 99.0");
    let call = run(&bench);
    let place = format!("{}:{line}:", bench.arg(SKILL));
    refused("the skill", &bench, &call, "S020", &[&place]);
    assert_eq!(call.stderr.matches("error[").count(), 1, "{}", call.stderr);
}

#[test]
fn a_skill_is_checked_beside_a_robot_and_a_scene() {
    let bench = Bench::new();
    let (skill, task) = (bench.arg(SKILL), bench.arg(TASK));
    let (robot, scene) = (bench.arg(ROBOT), bench.arg(SCENE));
    let check = || seeone(["check", &skill, &task, "--robot", &robot, "--scene", &scene]);
    let sound = check();
    assert_eq!(sound.status, Some(0), "{}", sound.stderr);
    let far = "pose = { xyz_m = [0.36, 4.2, 0.28], quat_xyzw = [0.0, 0.0, 1.0, 0.0] }";
    bench.set_line(SCENE, "pose", far);
    let told = check();
    assert_eq!(told.status, Some(1), "{}", told.stderr);
    let line = |start: &str| {
        let text = bench.text(SKILL);
        text.lines().position(|line| line.starts_with(start)).expect("a line") + 1
    };
    // The pose of the stage `arrive`, two lines below its name.
    let place = format!("error[S030]: {skill}:{}:", line("name = \"arrive\"") + 2);
    assert!(told.stderr.contains(&place), "{place} is not in {}", told.stderr);
    assert!(told.stderr.contains("beyond ur5-ag95-sim"), "{}", told.stderr);
    bench.set_line(TASK, "targets", "targets = { head = \"shelf\" }");
    let told = check();
    let place = format!("error[S031]: {skill}:{}:", line("relative_to = \"head\""));
    assert!(told.stderr.contains(&place), "{place} is not in {}", told.stderr);
    assert!(told.stderr.contains("has no frame \"shelf\""), "{}", told.stderr);
}
