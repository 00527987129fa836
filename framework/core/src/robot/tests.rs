#![allow(clippy::unwrap_used, reason = "tests")]

use super::*;
use crate::pose::difference;
use crate::random::{generator, uniform};
use crate::{Diagnostic, Pose};
use nalgebra::{Translation3, UnitQuaternion, Vector3};
use std::f64::consts::{FRAC_PI_2, PI};
use std::path::{Path, PathBuf};

fn ur5_file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../robots/ur5-ag95.urdf")
}

fn ur5() -> RobotModel {
    RobotModel::from_urdf(&ur5_file(), &RobotOptions::default()).unwrap()
}

#[test]
fn a_description_makes_the_same_robot_to_the_bit() {
    let options = RobotOptions {
        base: Pose::new(Vector3::new(0.1, 0.2, 0.3), Vector3::new(0.4, 0.5, 0.6)),
        home: Some(vec![0.1, -1.3, 1.1, 0.3, 0.2, 0.1]),
        jerk: 33.3,
        ..RobotOptions::default()
    };
    let robot = RobotModel::from_urdf(&ur5_file(), &options).unwrap();
    assert_eq!(RobotModel::from_description(&robot.description()).unwrap(), robot);
    let damaged = RobotDescription { urdf: "<robot".into(), ..robot.description() };
    assert_eq!(RobotModel::from_description(&damaged).unwrap_err().code, "R002");
}

/// The published table of the CB3 manual: a, d, alpha.
const DH: [(f64, f64, f64); 6] = [
    (0.0, 0.089159, FRAC_PI_2),
    (-0.425, 0.0, 0.0),
    (-0.39225, 0.0, 0.0),
    (0.0, 0.10915, FRAC_PI_2),
    (0.0, 0.09465, -FRAC_PI_2),
    (0.0, 0.0823, 0.0),
];

fn denavit_hartenberg(q: &[f64]) -> Pose {
    let turn_z = |a| {
        Pose::from_parts(
            Translation3::identity(),
            UnitQuaternion::from_axis_angle(&Vector3::z_axis(), a),
        )
    };
    DH.iter().zip(q).fold(turn_z(PI), |pose, ((a, d, alpha), q)| {
        let turn_x = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), *alpha);
        pose * turn_z(*q) * Pose::from_parts(Translation3::new(*a, 0.0, *d), turn_x)
    })
}

fn random_q(robot: &RobotModel, rng: &mut impl rand::Rng) -> Vec<f64> {
    robot.joints().iter().map(|j| uniform(rng, j.lower(), j.upper())).collect()
}

#[test]
fn forward_kinematics_are_the_published_table() {
    let robot = ur5();
    let mut rng = generator(1, "forward");
    for _ in 0..1000 {
        let q = random_q(&robot, &mut rng);
        let tcp = denavit_hartenberg(&q) * Translation3::new(0.0, 0.0, 0.190);
        let (distance, _) = difference(&robot.tool_pose(&q), &tcp);
        let turn = (robot.tool_pose(&q).rotation.to_rotation_matrix().matrix()
            - tcp.rotation.to_rotation_matrix().matrix())
        .norm();
        assert!(distance < 1e-9 && turn < 1e-9, "{distance} {turn}");
        let tool = robot.forward(&q)[6] * robot.tool();
        assert!(difference(&tool, &tcp).0 < 1e-9);
    }
}

#[test]
fn the_jacobian_is_the_derivative() {
    let base = Pose::new(Vector3::new(0.3, -0.1, 0.2), Vector3::new(0.2, 0.5, -0.3));
    let options = RobotOptions { base, ..RobotOptions::default() };
    let robot = RobotModel::from_urdf(&ur5_file(), &options).unwrap();
    let mut rng = generator(2, "jacobian");
    for _ in 0..50 {
        let q = random_q(&robot, &mut rng);
        let jacobian = robot.jacobian(&q);
        for joint in 0..6 {
            let step = 1e-6;
            let (mut a, mut b) = (q.clone(), q.clone());
            a[joint] -= step;
            b[joint] += step;
            let (a, b) = (robot.tool_pose(&a), robot.tool_pose(&b));
            let linear = (b.translation.vector - a.translation.vector) / (2.0 * step);
            let angular = (b.rotation * a.rotation.inverse()).scaled_axis() / (2.0 * step);
            assert!((linear - jacobian.fixed_view::<3, 1>(0, joint)).norm() < 1e-6);
            assert!((angular - jacobian.fixed_view::<3, 1>(3, joint)).norm() < 1e-6);
        }
    }
}

#[test]
fn the_gripper_is_the_ag95() {
    let gripper = ur5().gripper().clone();
    assert!((gripper.stroke_m() - 0.095).abs() < 1e-12);
    assert!((gripper.reach_m(0.0589) - 0.1966).abs() < 1e-12);
    assert!((gripper.reach_m(0.0484) - 0.1982).abs() < 1e-12);
    assert_eq!(gripper.palm_collision().len(), 1);
    for opening in [0.0, 0.03, 0.095] {
        let [left, right] = gripper.finger_poses(opening);
        let apart = left.translation.vector - right.translation.vector;
        assert!((apart.y - opening).abs() < 1e-12 && apart.x.abs() + apart.z.abs() < 1e-12);
        let Shape::Box { half_m } = gripper.finger_collision(opening)[0].shape else { panic!() };
        let tip = 0.0823 + gripper.reach_m(opening);
        let centre = gripper.finger_collision(opening)[0].pose.translation.z;
        assert!((centre + half_m.z - tip).abs() < 1e-9, "{centre} {tip}");
    }
}

#[test]
fn the_tool_comes_forward_with_the_pads_as_they_close() {
    let robot = ur5();
    assert_eq!(robot.tool_at(0.0), *robot.tool());
    let along = |opening| (robot.tool().inverse() * robot.tool_at(opening)).translation.vector.z;
    assert!((along(0.0952) + 0.0158).abs() < 1e-12 && (along(0.0589) + 0.0036).abs() < 1e-12);
    for opening in [0.0, 0.03, 0.095] {
        let finger = &robot.gripper().finger_collision(opening)[0];
        let Shape::Box { half_m } = finger.shape else { panic!() };
        let tip = finger.pose.translation.z + half_m.z;
        // 10.2 mm behind the tips, however far they are apart.
        assert!((tip - robot.tool_at(opening).translation.z - 0.0102).abs() < 1e-9);
    }
}

#[test]
fn the_picture_has_every_body() {
    let robot = ur5();
    let meshes = robot.meshes(robot.home(), 0.03);
    assert_eq!(meshes.len(), 12);
    let reach = meshes.iter().map(|m| m.bounds().1.coords.amax()).fold(0.0, f64::max);
    assert!((0.8..1.3).contains(&reach), "{reach}");
}

/// The fault of the UR5's file after replacing `from` by `to`; as an older URDF, whose
/// numbers the parser itself does not check.
fn broken(from: &str, to: &str) -> Diagnostic {
    let text = std::fs::read_to_string(ur5_file()).unwrap().replace(" version=\"1.2\"", "");
    assert!(text.contains(from), "{from}");
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("broken.urdf");
    std::fs::write(&file, text.replacen(from, to, 1)).unwrap();
    let fault = RobotModel::from_urdf(&file, &RobotOptions::default()).unwrap_err();
    assert_eq!(fault.place.as_ref().unwrap().file, file);
    fault
}

#[test]
fn refuses_a_broken_description_and_names_the_element() {
    let pan = r#"name="shoulder_pan_joint""#;
    let cases = [
        ("</robot>", "", "R002", ""),
        ("<link name=\"tool0\"/>", "<link name=\"tool0\"/><link name=\"tool0\"/>", "R003", "tool0"),
        ("name=\"flange\"", "name=\"tcp_mount\"", "R003", "tcp_mount"),
        ("<child link=\"forearm_link\"/>", "<child link=\"forarm_link\"/>", "R004", "forarm_link"),
        ("<child link=\"tool0\"/>", "<child link=\"forearm_link\"/>", "R005", "forearm_link"),
        ("<parent link=\"base_link\"/>", "<parent link=\"tcp\"/>", "R005", "forearm_link"),
        (
            "<parent link=\"ag95_palm\"/>",
            "<parent link=\"ag95_left_finger\"/>",
            "R005",
            "ag95_left_finger",
        ),
        ("<link name=\"tool0\"/>", "<link name=\"tool0\"/><link name=\"spare\"/>", "R005", "spare"),
        ("xyz=\"0 0 0.089159\" rpy", "xyz=\"0 0 NaN\" rpy", "R006", "shoulder_lift_joint"),
        ("radius=\"0.075\"", "radius=\"inf\"", "R006", "base_link"),
        ("effort=\"150\"", "effort=\"NaN\"", "R006", "shoulder_pan_joint"),
        (
            "<link name=\"tool0\"/>",
            "<link name=\"tool0\"><inertial><origin xyz=\"NaN 0 0\"/><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" izz=\"1\"/></inertial></link>",
            "R006",
            "tool0",
        ),
        ("lower=\"-3.141592653589793\"", "lower=\"4\"", "R007", "elbow_joint"),
        ("velocity=\"3.141592653589793\"", "velocity=\"0\"", "R007", "shoulder_pan_joint"),
        ("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 0\"/>", "R008", "shoulder_pan_joint"),
        ("<link name=\"tcp\"/>", "<link name=\"tpc\"/>", "R004", "tcp"),
        (
            &format!("{pan} type=\"revolute\""),
            &format!("{pan} type=\"planar\""),
            "R011",
            "shoulder_pan",
        ),
        ("radius=\"0.075\"", "radius=\"-0.075\"", "R012", "base_link"),
        ("upper=\"0.0475\"", "upper=\"0.05\"", "R014", "finger"),
    ];
    for (from, to, code, told) in cases {
        let fault = broken(from, to);
        assert_eq!(fault.code, code, "{from} -> {to}: {fault}");
        assert!(fault.cause.contains(told), "{from} -> {to}: {fault}");
    }
}

#[test]
fn refuses_wrong_options() {
    let refused = |options: RobotOptions| RobotModel::from_urdf(&ur5_file(), &options).unwrap_err();
    let wrong = RobotOptions { tool_link: "tcb".into(), ..RobotOptions::default() };
    assert_eq!(refused(wrong).hint.as_deref(), Some("did you mean \"tcp\"?"));
    for home in [vec![0.0; 5], vec![7.0; 6], vec![f64::NAN; 6]] {
        let wrong = RobotOptions { home: Some(home), ..RobotOptions::default() };
        assert_eq!(refused(wrong).code, "R013");
    }
    let wrong = RobotOptions { acceleration: f64::NAN, ..RobotOptions::default() };
    assert_eq!(refused(wrong).code, "R015");
    let gripper = GripperOptions { reach_m: vec![], ..GripperOptions::default() };
    assert_eq!(refused(RobotOptions { gripper, ..RobotOptions::default() }).code, "R014");
}
