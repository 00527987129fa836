#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use nalgebra::{Point3, Translation3, UnitQuaternion, Vector3};
use seeone_core::Pose;
use seeone_core::pose::{difference, rotation_from_approach};
use seeone_core::robot::{RobotModel, RobotOptions, Shape, Solid};
use seeone_plugin::motion::Obstacle;
use seeone_plugin::{
    Action, GripperCommand, JointTrajectory, KeyPose, Motion, MotionOutcome, MotionTask,
    PluginError, Program,
};
use seeone_qp_ik::{IkConfig, QpIk};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::path::Path;

const HOME: [f64; 6] = [0.0, -1.9, 1.9, -1.57, -1.57, 0.0];

fn ur5() -> RobotModel {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/ur5-ag95.urdf");
    RobotModel::from_urdf(&file, &RobotOptions::default()).unwrap()
}

fn planner() -> Planner {
    Planner::new(MotionConfig::default(), 1).unwrap()
}

fn plan(motion: &dyn Motion, keys: &[KeyPose], obstacles: &[Obstacle]) -> MotionOutcome {
    let kinematics = QpIk::new(IkConfig::default(), 1).unwrap();
    let task =
        MotionTask { start: &HOME, holding: false, carried: &[], key_poses: keys, obstacles };
    motion.plan(&ur5(), &kinematics, &task).unwrap()
}

fn planned(outcome: MotionOutcome) -> Program {
    match outcome {
        MotionOutcome::Planned { program, cost } => {
            assert!(cost.is_finite() && cost > 0.0);
            program
        }
        MotionOutcome::Infeasible { stage, reason } => panic!("{stage}: {reason}"),
    }
}

fn refused(outcome: MotionOutcome) -> (String, String) {
    match outcome {
        MotionOutcome::Planned { .. } => panic!("planned"),
        MotionOutcome::Infeasible { stage, reason } => (stage, reason),
    }
}

fn key(stage: &str, pose: Pose) -> KeyPose {
    KeyPose {
        stage: stage.into(),
        pose,
        approach_m: 0.0,
        opening_m: 0.03,
        until_contact_n: None,
        gripper: None,
        retreat_m: 0.0,
        lift_m: 0.0,
    }
}

fn downward(x: f64, y: f64, z: f64) -> Pose {
    let rotation = rotation_from_approach(&-Vector3::z(), &Vector3::y());
    Pose::from_parts(Translation3::new(x, y, z), rotation)
}

fn table() -> Obstacle {
    Obstacle::Table { height_m: 0.0, soft_m: 0.03 }
}

fn head(x: f64, y: f64, z: f64) -> Obstacle {
    Obstacle::Ellipsoid {
        name: "head".into(),
        centre: Point3::new(x, y, z),
        rotation: UnitQuaternion::identity(),
        semi_axes_m: Vector3::new(0.077, 0.099, 0.110),
    }
}

/// Pick from the table and put down elsewhere.
fn pick_and_place() -> Vec<KeyPose> {
    let pick = KeyPose {
        approach_m: 0.1,
        gripper: Some(GripperCommand::Close { force_n: 45.0 }),
        lift_m: 0.25,
        ..key("pick", downward(0.45, -0.15, 0.02))
    };
    let place = KeyPose {
        gripper: Some(GripperCommand::Open { opening_m: 0.05 }),
        retreat_m: 0.15,
        ..key("place", downward(0.35, 0.40, 0.30))
    };
    vec![pick, key("above", downward(0.35, 0.40, 0.45)), place]
}

fn moves(program: &Program) -> Vec<&JointTrajectory> {
    let moves = program.steps.iter().filter_map(|step| match &step.action {
        Action::Move(trajectory) | Action::MoveUntilContact { trajectory, .. } => Some(trajectory),
        Action::Grip(_) => None,
    });
    moves.collect()
}

#[test]
fn a_line_that_ends_with_contact_is_slow_all_the_way() {
    let mut keys = pick_and_place();
    keys[2].until_contact_n = Some(20.0);
    let program = planned(plan(&planner(), &keys, &[table()]));
    let felt: Vec<_> = program
        .steps
        .iter()
        .filter_map(|step| match &step.action {
            Action::MoveUntilContact { trajectory, force_n } => Some((step, trajectory, *force_n)),
            _ => None,
        })
        .collect();
    let [(step, trajectory, force_n)] = felt[..] else { panic!("one such line") };
    assert_eq!((step.stage.as_str(), step.purpose, force_n), ("place", "approach", 20.0));
    let robot = ur5();
    let tips = trajectory.positions.iter().map(|q| robot.tool_pose(q).translation.vector);
    let tips: Vec<Vector3<f64>> = tips.collect();
    let fastest = tips.windows(2).map(|pair| (pair[1] - pair[0]).norm()).fold(0.0, f64::max);
    assert!(fastest / trajectory.period_s <= MotionConfig::default().guarded_speed_m_s * 1.001);
}

#[test]
fn an_arm_that_stands_at_the_pose_with_something_in_the_hand_just_goes_on() {
    let pose = downward(0.35, 0.40, 0.30);
    let gripper = Some(GripperCommand::Close { force_n: 45.0 });
    let there = planned(plan(&planner(), &[KeyPose { gripper, ..key("hold", pose) }], &[]));
    let start = moves(&there).last().unwrap().positions.last().unwrap().clone();
    let keys = [KeyPose { lift_m: 0.1, ..key("hold", pose) }, key("on", downward(0.3, 0.3, 0.5))];
    let task =
        MotionTask { start: &start, holding: true, carried: &[], key_poses: &keys, obstacles: &[] };
    let kinematics = QpIk::new(IkConfig::default(), 1).unwrap();
    let program = planned(planner().plan(&ur5(), &kinematics, &task).unwrap());
    let steps: Vec<(&str, &str)> =
        program.steps.iter().map(|step| (step.stage.as_str(), step.purpose)).collect();
    assert_eq!(steps, [("hold", "lift"), ("on", "transit")], "no fingers move");
    assert_eq!(moves(&program)[0].positions[0], start);
}

#[test]
fn an_open_hand_meets_a_pose_with_its_pads_where_they_are_then() {
    let robot = ur5();
    let pose = downward(0.45, -0.15, 0.3);
    let close = Some(GripperCommand::Close { force_n: 45.0 });
    for (gripper, opening_m, back) in [(None, 0.095, 0.0158), (None, 0.0, 0.0), (close, 0.095, 0.0)]
    {
        let program =
            planned(plan(&planner(), &[KeyPose { opening_m, gripper, ..key("there", pose) }], &[]));
        let at = moves(&program).last().unwrap().positions.last().unwrap();
        let tool = robot.tool_pose(at).translation.vector;
        // The tool frame of the closed hand is further ahead: downward.
        assert!((tool.z - (0.3 - back)).abs() < 2e-4, "{opening_m}: {}", tool.z);
    }
}

#[test]
fn a_program_has_its_steps_in_order_and_grips_at_the_key_poses() {
    let keys = pick_and_place();
    let program = planned(plan(&planner(), &keys, &[table()]));
    let steps: Vec<(&str, &str)> =
        program.steps.iter().map(|step| (step.stage.as_str(), step.purpose)).collect();
    let wanted = [
        ("pick", "grip"),
        ("pick", "transit"),
        ("pick", "approach"),
        ("pick", "grip"),
        ("pick", "lift"),
        ("above", "transit"),
        ("place", "approach"),
        ("place", "grip"),
        ("place", "retreat"),
    ];
    assert_eq!(steps, wanted);
    let robot = ur5();
    let mut at = HOME.to_vec();
    let mut grips = Vec::new();
    for step in &program.steps {
        match &step.action {
            Action::Move(trajectory) | Action::MoveUntilContact { trajectory, .. } => {
                assert_eq!(trajectory.positions[0], at, "{} {}", step.stage, step.purpose);
                at.clone_from(trajectory.positions.last().unwrap());
            }
            Action::Grip(command) => grips.push((*command, robot.tool_pose(&at))),
        }
    }
    assert_eq!(grips[0].0, GripperCommand::Open { opening_m: 0.03 });
    for (grip, key) in grips[1..].iter().zip([&keys[0], &keys[2]]) {
        assert_eq!(Some(grip.0), key.gripper);
        let (distance, angle) = difference(&grip.1, &key.pose);
        assert!(distance < 1e-3 && angle < 1e-2);
    }
    let retreated = robot.tool_pose(&at).translation.vector;
    assert!((retreated - Vector3::new(0.35, 0.40, 0.45)).norm() < 1e-3);
}

#[test]
fn trajectories_keep_speed_and_acceleration_and_lines_are_straight() {
    let robot = ur5();
    let program = planned(plan(&planner(), &pick_and_place(), &[table(), head(0.0, 0.6, 0.3)]));
    for step in &program.steps {
        let Action::Move(trajectory) = &step.action else { continue };
        let (samples, period) = (&trajectory.positions, trajectory.period_s);
        assert!(samples.iter().all(|q| robot.within_limits(q)));
        for (i, joint) in robot.joints().iter().enumerate() {
            let mut before = 0.0;
            let speeds = samples.windows(2).map(|pair| (pair[1][i] - pair[0][i]) / period);
            for speed in speeds.chain([0.0]) {
                assert!(speed.abs() <= 0.5 * joint.velocity() + 1e-9);
                assert!((speed - before).abs() / period <= robot.acceleration() + 1e-6);
                before = speed;
            }
        }
        let tips: Vec<Vector3<f64>> =
            samples.iter().map(|q| robot.tool_pose(q).translation.vector).collect();
        let speed = |pair: &[Vector3<f64>]| (pair[1] - pair[0]).norm() / period;
        if step.purpose == "transit" {
            continue;
        }
        assert!(tips.windows(2).all(|pair| speed(pair) <= 0.25 + 1e-6));
        let (from, to) = (tips[0], *tips.last().unwrap());
        let along = (to - from).normalize();
        for tip in &tips {
            let off = (tip - from) - along * along.dot(&(tip - from));
            assert!(off.norm() < 2e-4, "{} {}: {} m off", step.stage, step.purpose, off.norm());
        }
        if step.purpose == "approach" {
            let near = |pair: &&[Vector3<f64>]| (pair[0] - to).norm() < 0.049;
            assert!(tips.windows(2).filter(near).all(|pair| speed(pair) <= 0.1 + 1e-6));
        }
    }
}

#[test]
fn plans_around_a_head_where_the_straight_move_refuses() {
    let start = [-0.8, HOME[1], HOME[2], HOME[3], HOME[4], HOME[5]];
    let keys = [key("left", downward(0.45, 0.35, 0.3))];
    let obstacles = [table(), head(0.5, 0.0, 0.3)];
    let task = MotionTask {
        start: &start,
        holding: false,
        carried: &[],
        key_poses: &keys,
        obstacles: &obstacles,
    };
    let kinematics = QpIk::new(IkConfig::default(), 1).unwrap();
    let ask =
        |motion: &dyn Motion, task: &MotionTask| motion.plan(&ur5(), &kinematics, task).unwrap();
    // One branch alone: another may well pass on the far side.
    let one = MotionConfig { branches: 1, ..MotionConfig::default() };
    let straight = JointLine::new(one.clone(), 1).unwrap();
    planned(ask(&straight, &MotionTask { obstacles: &obstacles[..1], ..task }));
    let (stage, reason) = refused(ask(&straight, &task));
    assert_eq!(stage, "left");
    assert!(reason.contains("head") && reason.contains("mm"), "{reason}");
    let around = Planner::new(one, 1).unwrap();
    let program = planned(ask(&around, &task));
    assert_eq!(program, planned(ask(&around, &task)));
    // The tips of the fingers, measured without the planner's own shapes.
    let robot = ur5();
    for trajectory in moves(&program) {
        for q in &trajectory.positions {
            let tip = robot.tool_pose(q) * Point3::new(0.0, 0.0, 0.01) - Point3::new(0.5, 0.0, 0.3);
            let inside = tip.component_div(&Vector3::new(0.077, 0.099, 0.110)).norm();
            assert!(inside > 1.0, "{inside}");
        }
    }
}

#[test]
fn what_cannot_be_done_says_at_which_stage_and_by_how_much() {
    let far = [key("pick", downward(0.45, -0.15, 0.3)), key("hang", downward(1.5, 0.0, 0.3))];
    let (stage, reason) = refused(plan(&planner(), &far, &[table()]));
    assert!(stage == "hang" && reason.contains("out of reach"), "{stage}: {reason}");
    let far = [KeyPose { lift_m: 0.1, ..far[0].clone() }, far[1].clone()];
    let (stage, reason) = refused(plan(&planner(), &far, &[table()]));
    assert!(stage == "hang" && reason.contains("mm"), "{stage}: {reason}");
    let (stage, reason) =
        refused(plan(&planner(), &[key("pick", downward(0.45, 0.0, -0.05))], &[table()]));
    assert!(stage == "pick" && reason.contains("table"), "{reason}");
    let sunk = KeyPose { lift_m: 0.1, ..key("pick", downward(0.45, 0.0, -0.015)) };
    planned(plan(&planner(), &[sunk], &[table()]));
}

/// The corners of a box in the hand, 16 cm wide and 8 cm deep.
fn parcel() -> Vec<Point3<f64>> {
    let edges = |k: usize| [k & 1, k >> 1 & 1, k >> 2].map(|bit| 2.0 * bit as f64 - 1.0);
    (0..8).map(edges).map(|[x, y, z]| Point3::new(0.08 * x, 0.08 * y, 0.05 + 0.04 * z)).collect()
}

/// The least distance of the box from the ball-like head at `centre` on a move, by the points of
/// a grid over it.
fn parcel_from_head(trajectory: &JointTrajectory, centre: Point3<f64>) -> f64 {
    let robot = ur5();
    let steps = || (-8..=8).map(|k| f64::from(k) / 8.0);
    let grid: Vec<Point3<f64>> = steps()
        .flat_map(|x| steps().map(move |y| (x, y)))
        .flat_map(|(x, y)| steps().map(move |z| [0.08 * x, 0.08 * y, 0.05 + 0.04 * z]))
        .map(Point3::from)
        .collect();
    let apart = |p: Point3<f64>| (p - centre).norm() - 0.1;
    let tools = trajectory.positions.iter().map(|q| robot.tool_pose(q));
    tools.flat_map(|tool| grid.iter().map(move |p| apart(tool * p))).fold(f64::INFINITY, f64::min)
}

#[test]
fn what_is_carried_goes_around_what_it_is_not_brought_to() {
    let kinematics = QpIk::new(IkConfig::default(), 1).unwrap();
    let centre = Point3::new(0.45, 0.0, 0.10);
    let ball = Obstacle::Ellipsoid {
        name: "head".into(),
        centre,
        rotation: UnitQuaternion::identity(),
        semi_axes_m: Vector3::repeat(0.1),
    };
    let obstacles = [table(), ball];
    let close = Some(GripperCommand::Close { force_n: 45.0 });
    let side = |y| KeyPose { lift_m: 0.01, gripper: close, ..key("side", downward(0.45, y, 0.27)) };
    let keys = [side(-0.3), side(0.3)];
    let nearest = |carried: &[Point3<f64>]| {
        let task = MotionTask {
            start: &HOME,
            holding: false,
            carried,
            key_poses: &keys,
            obstacles: &obstacles,
        };
        let program = planned(planner().plan(&ur5(), &kinematics, &task).unwrap());
        let transit = program.steps.iter().rfind(|step| step.purpose == "transit").unwrap();
        let Action::Move(trajectory) = &transit.action else { panic!() };
        parcel_from_head(trajectory, centre)
    };
    assert!(nearest(&[]) < 0.0, "{}", nearest(&[]));
    // Between two looks it comes a few millimetres nearer than the margin of 30.
    assert!(nearest(&parcel()) > 0.02, "{}", nearest(&parcel()));
}

#[test]
fn what_is_carried_touches_what_it_is_brought_to_and_nothing_else() {
    let kinematics = QpIk::new(IkConfig::default(), 1).unwrap();
    let close = Some(GripperCommand::Close { force_n: 45.0 });
    let open = Some(GripperCommand::Open { opening_m: 0.06 });
    // Taken from the table, 5 cm over it, and put down until it is in the head by 3 cm.
    let keys = [
        KeyPose { gripper: close, lift_m: 0.25, ..key("pick", downward(0.45, -0.25, 0.09)) },
        key("over", downward(0.45, 0.25, 0.45)),
        KeyPose { gripper: open, ..key("put", downward(0.45, 0.25, 0.27)) },
    ];
    let plan = |obstacles: &[Obstacle]| {
        let (start, carried) = (&HOME, &parcel());
        let task = MotionTask { start, holding: false, carried, key_poses: &keys, obstacles };
        planner().plan(&ur5(), &kinematics, &task).unwrap()
    };
    let onto = head(0.45, 0.25, 0.10);
    planned(plan(&[table(), onto.clone()]));
    // A rod that the parcel would brush past on its way down, and the hand would not.
    let rod = Obstacle::Solid(Solid {
        part: "rod".into(),
        shape: Shape::Cylinder { radius_m: 0.005, length_m: 0.02 },
        pose: Pose::translation(0.45, 0.35, 0.32),
    });
    let (stage, reason) = refused(plan(&[table(), onto, rod]));
    assert_eq!(stage, "put");
    assert!(reason.contains("held") && reason.contains("rod"), "{reason}");
}

#[test]
fn what_is_no_task_is_refused() {
    let kinematics = QpIk::new(IkConfig::default(), 1).unwrap();
    let ask = |start: &[f64], keys: &[KeyPose]| {
        planner().plan(
            &ur5(),
            &kinematics,
            &MotionTask { start, holding: false, carried: &[], key_poses: keys, obstacles: &[] },
        )
    };
    let good = key("pick", downward(0.45, 0.0, 0.3));
    let nan = key("pick", downward(f64::NAN, 0.0, 0.3));
    let negative = KeyPose { lift_m: -0.1, ..good.clone() };
    assert!(matches!(ask(&HOME[..5], std::slice::from_ref(&good)), Err(PluginError::Input(_))));
    assert!(matches!(ask(&[9.0; 6], &[good]), Err(PluginError::Input(_))));
    assert!(matches!(ask(&HOME, &[nan]), Err(PluginError::Input(_))));
    assert!(matches!(ask(&HOME, &[negative]), Err(PluginError::Input(_))));
    for wrong in [
        MotionConfig { speed: 1.5, ..MotionConfig::default() },
        MotionConfig { line_step_m: f64::NAN, ..MotionConfig::default() },
        MotionConfig { clearance_m: -1.0, ..MotionConfig::default() },
    ] {
        assert!(matches!(Planner::new(wrong, 0), Err(PluginError::Configuration(_))));
    }
}

/// A cap lies on the mat at any yaw, its visor's front edge 15.5 cm from its middle; the
/// hand comes from the front, 15 degrees downward in the cap's frame, and puts it on a
/// head that looks at the robot.
fn wearing(yaw: f64, turn: f64, flip: bool) -> Vec<KeyPose> {
    let about = |axis, angle| {
        Pose::from_parts(Translation3::identity(), UnitQuaternion::from_axis_angle(&axis, angle))
    };
    let tilt: f64 = 15f64.to_radians();
    let approach = Vector3::new(0.0, -tilt.cos(), -tilt.sin());
    let grasp = Pose::from_parts(
        Translation3::new(0.0, 0.155, 0.0),
        rotation_from_approach(&approach, &Vector3::z()),
    ) * about(Vector3::y_axis(), turn)
        * about(Vector3::z_axis(), if flip { PI } else { 0.0 });
    let lying = Pose::translation(0.45, -0.15, 0.025) * about(Vector3::z_axis(), yaw);
    let worn = Pose::translation(0.35, 0.40, 0.33) * about(Vector3::z_axis(), PI);
    let pick = KeyPose {
        approach_m: 0.1,
        gripper: Some(GripperCommand::Close { force_n: 45.0 }),
        lift_m: 0.25,
        ..key("pick", lying * grasp)
    };
    let release = KeyPose {
        gripper: Some(GripperCommand::Open { opening_m: 0.03 }),
        retreat_m: 0.15,
        ..key("release", worn * grasp)
    };
    let above = key("above", Pose::translation(0.0, 0.0, 0.15) * release.pose);
    vec![pick, above, release]
}

#[test]
fn a_cap_can_be_put_on_a_head_from_most_directions() {
    let obstacles = [table(), head(0.35, 0.40, 0.28)];
    let feasible = |yaw: f64| {
        let turns = [0.0, FRAC_PI_2 / 3.0, FRAC_PI_2 / 1.5, FRAC_PI_2];
        let turns = turns.into_iter().flat_map(|turn| [turn, -turn]);
        turns.flat_map(|turn| [(turn, false), (turn, true)]).any(|(turn, flip)| {
            let outcome = plan(&planner(), &wearing(yaw, turn, flip), &obstacles);
            matches!(outcome, MotionOutcome::Planned { .. })
        })
    };
    let share = (0..12).filter(|k| feasible(TAU * f64::from(*k) / 12.0)).count();
    assert!(share >= 10, "{share} of 12");
}
