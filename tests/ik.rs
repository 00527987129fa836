//! `ik` on files that these tests generate, judged by the published Denavit-Hartenberg table
//! of the UR5 and by nothing of the house.

mod support;

use nalgebra::{Matrix4, Translation3, UnitQuaternion, Vector3};
use seeone_core::random::{direction, generator, uniform};
use serde_json::{Value, json};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::fs;
use support::{Bench, seeone};
use tempfile::TempDir;

/// a, d and alpha of each joint (CB3 manual), metres and radians.
const DH: [(f64, f64, f64); 6] = [
    (0.0, 0.089159, FRAC_PI_2),
    (-0.425, 0.0, 0.0),
    (-0.39225, 0.0, 0.0),
    (0.0, 0.10915, FRAC_PI_2),
    (0.0, 0.09465, -FRAC_PI_2),
    (0.0, 0.0823, 0.0),
];
const LIMITS: [f64; 6] = [TAU, TAU, PI, TAU, TAU, TAU];
const SPEED: f64 = PI;

/// The flange in `base_link`, which is the controller's base turned by pi.
fn flange(q: &[f64]) -> Matrix4<f64> {
    let base = Matrix4::new_nonuniform_scaling(&Vector3::new(-1.0, -1.0, 1.0));
    DH.iter().zip(q).fold(base, |pose, ((a, d, alpha), q)| {
        pose * Matrix4::from_axis_angle(&Vector3::z_axis(), *q)
            * Translation3::new(*a, 0.0, *d).to_homogeneous()
            * Matrix4::from_axis_angle(&Vector3::x_axis(), *alpha)
    })
}

/// Metres and radians between two poses.
fn off(a: &Matrix4<f64>, b: &Matrix4<f64>) -> (f64, f64) {
    let between = (a.column(3) - b.column(3)).norm();
    let turn = a.fixed_view::<3, 3>(0, 0).tr_mul(&b.fixed_view::<3, 3>(0, 0));
    let skew = turn - turn.transpose();
    let sine = 0.5 * Vector3::new(skew[(2, 1)], skew[(0, 2)], skew[(1, 0)]).norm();
    (between, sine.atan2(0.5 * (turn.trace() - 1.0)))
}

fn rows(pose: &Matrix4<f64>) -> Value {
    json!(pose.row_iter().map(|row| row.iter().copied().collect()).collect::<Vec<Vec<f64>>>())
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("joints").iter().map(|q| q.as_f64().expect("a number")).collect()
}

fn within(q: &[f64]) -> bool {
    q.len() == 6 && q.iter().zip(LIMITS).all(|(q, limit)| q.abs() <= limit + 1e-12)
}

/// Writes `asked`, asks, and gives the answers, one for each in its order.
fn answers(asked: &[Value], extra: &[&str]) -> Vec<Value> {
    let folder = TempDir::new().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    let (targets, out) = (path("T.json"), path("A.json"));
    fs::write(&targets, json!(asked).to_string()).expect("a written file");
    let words = ["ik", "--targets", &targets, "--out", &out];
    let call = seeone(words.iter().chain(extra));
    assert_eq!((call.status, call.stdout.as_str()), (Some(0), ""), "{}", call.stderr);
    let text = fs::read_to_string(&out).expect("answers");
    let answers: Vec<Value> = serde_json::from_str(&text).expect("a JSON array");
    let ids = |of: &[Value]| of.iter().map(|entry| entry["id"].clone()).collect::<Vec<_>>();
    assert_eq!(ids(&answers), ids(asked));
    answers
}

#[test]
fn a_thousand_reachable_poses_are_all_answered_within_the_tolerance() {
    let mut rng = generator(6, "reachable");
    let poses: Vec<Matrix4<f64>> =
        (0..1000).map(|_| flange(&LIMITS.map(|limit| uniform(&mut rng, -limit, limit)))).collect();
    let asked: Vec<Value> =
        poses.iter().enumerate().map(|(id, p)| json!({ "id": id, "pose": rows(p) })).collect();
    let mut touching = 0;
    for (answer, pose) in answers(&asked, &["--from-home"]).iter().zip(&poses) {
        assert_eq!(answer["status"], "solved", "{answer}");
        let q = numbers(&answer["q"]);
        assert!(within(&q), "{answer}");
        let (metres, radians) = off(&flange(&q), pose);
        assert!(metres <= 1e-3 && radians <= 1e-2, "{answer}");
        let told = |key: &str| answer[key].as_f64().expect("a number");
        assert!((told("position_error_m") - metres).abs() < 1e-9, "{answer}");
        assert!((told("rotation_error_rad") - radians).abs() < 1e-6, "{answer}");
        assert!(told("time_us") > 0.0);
        let pair = answer["collision"].as_str();
        assert_eq!(pair.is_some(), answer["reason"].is_string(), "{answer}");
        assert!(pair.is_none_or(|pair| pair.split('-').count() == 2), "{answer}");
        touching += usize::from(pair.is_some());
    }
    // Some poses can be reached only by folding the arm into itself.
    assert!((10..150).contains(&touching), "{touching}");
}

#[test]
fn what_is_out_of_reach_has_no_joints_and_says_by_how_much() {
    let far = Matrix4::new_translation(&Vector3::new(1.5, 0.0, 0.3));
    let answer = &answers(&[json!({ "id": "far", "pose": rows(&far) })], &[])[0];
    assert_eq!(answer["status"], "infeasible");
    assert!(answer["q"].is_null() && answer["collision"].is_null(), "{answer}");
    let missing = answer["position_error_m"].as_f64().expect("a number");
    assert!((0.4..0.9).contains(&missing), "{answer}");
    let reason = answer["reason"].as_str().expect("a reason");
    assert!(reason.contains(&format!("{:.1} mm", 1e3 * missing)), "{reason}");
}

#[test]
fn the_tool_is_in_front_of_the_flange_and_the_next_answer_starts_at_the_last() {
    let q = [0.4, -1.7, 1.5, -1.3, -1.4, 0.3];
    let tool = flange(&q) * Matrix4::new_translation(&Vector3::new(0.0, 0.0, 0.190));
    let asked: Vec<Value> = [1, 2].map(|id| json!({ "id": id, "pose": rows(&tool) })).into();
    let answers = answers(&asked, &["--frame", "tcp"]);
    let found = numbers(&answers[0]["q"]);
    let (metres, radians) = off(&flange(&found), &flange(&q));
    assert!(metres < 1e-6 && radians < 1e-6, "{metres} {radians}");
    assert_eq!(answers[0]["q"], answers[1]["q"]);
    // Wide open, the pads are further back and the flange has to be further ahead.
    let wide = self::answers(&asked[..1], &["--frame", "tcp", "--opening", "0.095"]);
    let ahead = flange(&q) * Matrix4::new_translation(&Vector3::new(0.0, 0.0, 0.0157));
    let (metres, radians) = off(&flange(&numbers(&wide[0]["q"])), &ahead);
    assert!(metres < 2e-4 && radians < 1e-6, "{metres} {radians}");
}

/// Straight lines of 0.15 m at 0.19 m/s with a little turn, from postures that are away from
/// singularities and limits.
fn lines() -> Vec<Vec<Matrix4<f64>>> {
    let mut rng = generator(7, "lines");
    (0..20)
        .map(|_| {
            let around = [0.0, -1.6, 1.5, -1.2, -1.5, 0.0];
            let first = flange(&around.map(|q| q + uniform(&mut rng, -0.3, 0.3)));
            let (along, turn) = (direction(&mut rng) * 0.15, direction(&mut rng) * 0.1);
            (0..=100)
                .map(|k| f64::from(k) / 100.0)
                .map(|share| {
                    let turn = UnitQuaternion::new(turn * share).to_homogeneous();
                    let mut pose = first * turn;
                    pose.fixed_view_mut::<3, 1>(0, 3).zip_apply(&along, |p, d| *p += share * d);
                    pose
                })
                .collect()
        })
        .collect()
}

#[test]
fn straight_lines_are_followed_on_one_branch_within_their_speeds() {
    let lines = lines();
    let asked: Vec<Value> = lines
        .iter()
        .enumerate()
        .map(|(id, line)| json!({ "id": id, "poses": line.iter().map(rows).collect::<Vec<_>>() }))
        .collect();
    for (answer, line) in answers(&asked, &["--path"]).iter().zip(&lines) {
        assert_eq!(answer["fraction"], 1.0, "{}", answer["reason"]);
        let path: Vec<Vec<f64>> =
            answer["q"].as_array().expect("a path").iter().map(numbers).collect();
        assert_eq!(path.len(), line.len());
        for (q, pose) in path.iter().zip(line) {
            let (metres, radians) = off(&flange(q), pose);
            assert!(within(q) && metres <= 2e-5 && radians <= 1e-4, "{metres} {radians}");
        }
        for pair in path.windows(2) {
            let fastest = pair[0].iter().zip(&pair[1]).map(|(a, b)| (a - b).abs() / 0.008);
            assert!(fastest.fold(0.0, f64::max) <= SPEED + 1e-9);
        }
    }
}

#[test]
fn a_path_that_leaves_the_reach_is_followed_as_far_as_it_goes() {
    let first = flange(&[0.0, -1.6, 1.5, -1.2, -1.5, 0.0]);
    let poses: Vec<Value> = (0..400)
        .map(|k| rows(&(Matrix4::new_translation(&(Vector3::x() * 0.002 * f64::from(k))) * first)))
        .collect();
    let asked = json!({ "id": "out", "poses": poses });
    let answer = &answers(&[asked], &["--path"])[0];
    let fraction = answer["fraction"].as_f64().expect("a number");
    let followed = answer["q"].as_array().expect("a path").len();
    assert!((0.2..0.9).contains(&fraction), "{fraction}");
    assert!((fraction - followed as f64 / 400.0).abs() < 1e-12);
    let reason = answer["reason"].as_str().expect("a reason");
    assert!(reason.contains(&format!("pose {followed}: ")), "{reason}");
}

#[test]
fn both_plugins_and_a_scene_answer() {
    let pose = rows(&flange(&[0.4, -1.7, 1.5, -1.3, -1.4, 0.3]));
    let asked = [json!({ "id": 0, "pose": pose })];
    let other = ["--method", "kinematics=damped-least-squares", "--scene", "scenes/head.toml"];
    assert_eq!(answers(&asked, &other)[0]["status"], "solved");
    // The flange under the table.
    let low = rows(&flange(&[0.0, -0.1, 0.3, -1.3, -1.5, 0.0]));
    let answer = &answers(&[json!({ "id": 0, "pose": low })], &other[2..])[0];
    assert!(answer["collision"].as_str().is_some_and(|pair| pair.ends_with("-table")), "{answer}");
    // The stand of the camera where the hand should be.
    let bench = Bench::new();
    let at = flange(&[0.4, -1.7, 1.5, -1.3, -1.4, 0.3]);
    bench.append(
        "scenes/head.toml",
        &format!(
            "\n[[obstacle]]\nname = \"stand\"\nradius_m = 0.02\nlength_m = 1.5\n\
             pose = {{ xyz_m = [{}, {}, 0.7], quat_xyzw = [0.0, 0.0, 0.0, 1.0] }}\n",
            at[(0, 3)],
            at[(1, 3)]
        ),
    );
    let answer = &answers(&asked, &["--scene", &bench.arg("scenes/head.toml")])[0];
    assert!(answer["collision"].as_str().is_some_and(|pair| pair.ends_with("-stand")), "{answer}");
    assert!(answer["reason"].as_str().is_some_and(|why| why.contains("mm")), "{answer}");
}
