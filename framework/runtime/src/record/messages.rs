//! From what a run left to the messages of its recording.

use super::Channel;
use crate::run::{Acted, Assignment, Failed, Perceived, Planned, StageEvent, Transferred};
use nalgebra::Point3;
use seeone_core::Pose;
use seeone_core::pose::PoseFields;
use seeone_plugin::{Action, CanonicalCloud, GripperCommand, KeyPose, Step, Verdict};
use serde_json::{Map, Value, json};

/// What a run left; a step that was not reached left nothing.
pub(crate) struct Record<'a> {
    pub(crate) assignment: &'a Assignment,
    pub(crate) perceived: Option<&'a Perceived>,
    pub(crate) transferred: Option<&'a Transferred>,
    pub(crate) planned: Option<&'a Planned>,
    pub(crate) acted: Option<&'a Acted>,
    pub(crate) verdict: Option<&'a Verdict>,
    pub(crate) failed: Option<&'a Failed>,
    pub(crate) stages: &'a [StageEvent],
}

/// A message with its time in seconds of the cell's clock.
pub(super) struct Message {
    pub(super) channel: Channel,
    pub(super) time_s: f64,
    pub(super) body: Value,
}

impl Record<'_> {
    /// The messages, in order of time.
    pub(super) fn messages(&self) -> Vec<Message> {
        let before = |channel, body| Message { channel, time_s: 0.0, body };
        let mut messages = vec![before(Channel::Run, self.assignment.to_json())];
        if let Some(perceived) = self.perceived {
            let clouds =
                [("demonstration", &perceived.demonstration), ("instance", &perceived.instance)];
            let clouds = clouds.map(|(of, cloud)| before(Channel::Cloud, canonical(of, cloud)));
            messages.extend(clouds);
        }
        messages.extend(self.transferred.map(|t| before(Channel::Candidates, candidates(t))));
        if let Some(planned) = self.planned {
            messages.push(before(Channel::KeyPoses, key_poses(planned)));
            let steps: Vec<Value> = planned.program.steps.iter().map(step).collect();
            let body = json!({ "cost": rounded(planned.cost), "steps": steps });
            messages.push(before(Channel::Trajectory, body));
        }
        let end_s = self.acted.map_or(0.0, Acted::end_s);
        messages.extend(self.acted.into_iter().flat_map(moments));
        for StageEvent { name, ok, reason, .. } in self.stages {
            // How long a step took is of this machine and not of the run.
            let body = json!({ "name": name, "ok": ok, "reason": reason });
            messages.push(Message { channel: Channel::Stages, time_s: end_s, body });
        }
        let body = self.verdict();
        messages.push(Message { channel: Channel::Verdict, time_s: end_s, body });
        messages
    }

    fn verdict(&self) -> Value {
        let verdict = self.verdict;
        let failed = self.failed.map(|failed| format!("{}: {}", failed.stage, failed.reason));
        json!({
            "grasped": verdict.map(|v| v.grasped),
            "success": verdict.map(|v| v.success),
            "error_m": verdict.and_then(|v| v.error_m),
            "error_d": verdict.and_then(|v| v.error_d),
            "tilt_deg": verdict.and_then(|v| v.tilt_deg),
            "nose_up_deg": verdict.and_then(|v| v.nose_up_deg),
            "yaw_deg": verdict.and_then(|v| v.yaw_deg),
            "reason": failed.or_else(|| verdict.map(|v| v.reason.clone())),
        })
    }
}

/// Robot samples and snapshots of the object, by time; at one time the robot first.
fn moments(acted: &Acted) -> Vec<Message> {
    let robot = acted.robot.iter().map(|sample| Message {
        channel: Channel::Robot,
        time_s: sample.time_s,
        body: json!({
            "joints": numbers(&sample.state.joints),
            "opening_m": rounded(sample.state.opening_m),
        }),
    });
    let object = acted.object.iter().map(|snapshot| Message {
        channel: Channel::Object,
        time_s: snapshot.time_s,
        body: json!({
            "vertices": snapshot.vertices.iter().map(|v| numbers(v)).collect::<Vec<_>>(),
        }),
    });
    let mut messages: Vec<Message> = robot.chain(object).collect();
    messages.sort_by(|a, b| a.time_s.total_cmp(&b.time_s).then(a.channel.cmp(&b.channel)));
    messages
}

fn canonical(of: &str, cloud: &CanonicalCloud) -> Value {
    json!({
        "of": of,
        "points": points(&cloud.points),
        "nocs": points(&cloud.nocs),
        "confidence": cloud.confidence.iter().map(|c| numbers(c)).collect::<Vec<_>>(),
    })
}

fn candidates(transferred: &Transferred) -> Value {
    let grasps = transferred.grasps.iter().map(|grasp| {
        json!({
            "canonical": pose(&grasp.candidate.pose),
            "world": pose(&grasp.tool),
            "loss": grasp.candidate.loss,
            "confidence": rounded(grasp.candidate.confidence),
            "origin": grasp.candidate.origin,
            "scale_m": rounded(grasp.held.scale),
            "patch": grasp.patch,
            "residual_m": rounded(grasp.residual_m),
        })
    });
    json!({
        "demonstrated": pose(&transferred.demonstrated.tool),
        "scale_m": rounded(transferred.demonstrated.scale),
        "candidates": grasps.collect::<Vec<_>>(),
    })
}

fn key_poses(planned: &Planned) -> Value {
    let key_pose = |key: &KeyPose| {
        json!({
            "stage": key.stage,
            "pose": pose(&key.pose),
            "approach_m": key.approach_m,
            "opening_m": key.opening_m,
            "until_contact_n": key.until_contact_n,
            "gripper": key.gripper.as_ref().map(gripper),
            "retreat_m": key.retreat_m,
            "lift_m": key.lift_m,
        })
    };
    json!({
        "grasp": planned.grasp,
        "turn_deg": planned.turn.about_closing_deg,
        "flipped": planned.turn.flipped,
        "tilt_deg": planned.turn.tilt_deg,
        "key_poses": planned.key_poses.iter().map(key_pose).collect::<Vec<_>>(),
    })
}

fn step(step: &Step) -> Value {
    let mut body = Map::from_iter([
        ("stage".to_owned(), json!(step.stage)),
        ("purpose".to_owned(), json!(step.purpose)),
    ]);
    if let Action::MoveUntilContact { force_n, .. } = &step.action {
        body.insert("until_contact_n".to_owned(), json!(force_n));
    }
    match &step.action {
        Action::Move(trajectory) | Action::MoveUntilContact { trajectory, .. } => {
            let positions: Vec<Value> =
                trajectory.positions.iter().map(|joints| numbers(joints)).collect();
            body.insert("period_s".to_owned(), json!(trajectory.period_s));
            body.insert("positions".to_owned(), json!(positions));
        }
        Action::Grip(command) => {
            body.insert("gripper".to_owned(), gripper(command));
        }
    }
    Value::Object(body)
}

fn gripper(command: &GripperCommand) -> Value {
    match command {
        GripperCommand::Close { force_n } => json!({ "close_n": force_n }),
        GripperCommand::Open { opening_m } => json!({ "open_m": opening_m }),
    }
}

pub(crate) fn pose(pose: &Pose) -> Value {
    let fields = PoseFields::from(pose);
    json!({ "xyz_m": numbers(&fields.xyz_m), "quat_xyzw": fields.quat_xyzw })
}

fn points(points: &[Point3<f64>]) -> Vec<Value> {
    points.iter().map(|point| numbers(point.coords.as_slice())).collect()
}

fn numbers(values: &[f64]) -> Value {
    values.iter().map(|value| rounded(*value)).collect()
}

/// To 1e-5: a hundredth of a millimetre, and short to write. What is not finite is null.
fn rounded(value: f64) -> Value {
    json!((value * 1e5).round() / 1e5)
}
