//! Wearing: the cap is pulled onto the head from behind as a hood is, turned level and drawn down.

use super::{Lesson, TOLERANCE_D, grasp, missing, pick};
use crate::simulated::SimulatedCell;
use anyhow::Result;
use nalgebra::{Translation3, UnitQuaternion, Vector3};
use seeone_core::Pose;
use seeone_plugin::{GripperCommand, Measure};
use seeone_runtime::files::{RelativeTo, Scene, Stage};
use std::collections::BTreeMap;

/// Where the cap is on its way onto the head, beside where it is worn.
#[derive(Clone, Copy, Debug)]
struct Over {
    /// Metres behind.
    back_m: f64,
    /// Metres above.
    height_m: f64,
    /// Degrees by which its nose is up.
    nose_up_deg: f64,
}

/// It comes above and behind the head: what is soft hangs straight down from its visor, its mouth
/// towards the hand, and is behind the head from here on, ...
const ARRIVE: Over = Over { back_m: 0.210, height_m: 0.220, nose_up_deg: 25.0 };
/// ... and sinks, so that the back of its hem is as low as the back of the head, ...
const BEHIND: Over = Over { back_m: 0.210, height_m: 0.150, nose_up_deg: 30.0 };
/// ... which it is pulled onto as a hood is: mouth first, ...
const HOOK: Over = Over { back_m: 0.140, height_m: 0.090, nose_up_deg: 60.0 };
/// ... until the back of the head is in it.
const COVER: Over = Over { back_m: 0.060, height_m: 0.040, nose_up_deg: 60.0 };
/// What it may meet before the back of the head is at its mouth, newtons.
const PULL_N: f64 = 30.0;
/// Then it is turned over the head, about its middle, which a cap slides around with the least
/// resistance, until its nose is up by so much, degrees: step by step, for the hand goes from
/// one key pose to the next on a chord; ...
const TURNS: [(&str, f64); 3] = [("turn", 40.0), ("tip", 20.0), ("level", 2.0)];
/// ... neither that nor the last of the pull against more than this, newtons.
const MOST_N: f64 = 20.0;
/// It is drawn down onto the head, metres at most, ...
const DRAW_M: f64 = 0.055;
/// ... until the head bears this, newtons, and let go: how deep a crown sits differs by 12 mm
/// (standard deviation) from cap to cap.
const TOUCH_N: f64 = 10.0;

/// The expert's key poses at the head.
pub(super) fn lesson(cell: &SimulatedCell, scene: &Scene) -> Result<Lesson> {
    let head = scene.head().ok_or_else(|| missing(scene, "head"))?.pose;
    let (grasp, now) = grasp(cell)?;
    let right = cell.worn_vertices()?;
    let worn = grasp.tool_on(&right);
    let over = |place: Over| {
        let nose_up = place.nose_up_deg.to_radians();
        let turn = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), nose_up);
        let shift = Translation3::new(0.0, -place.back_m, place.height_m);
        head * Pose::from_parts(shift, turn) * head.inverse() * worn
    };
    let at_head = |name, pose| Stage::through(name, RelativeTo::Frame("head".to_owned()), pose);
    let guarded =
        |name, place, most_n| Stage { until_contact_n: Some(most_n), ..at_head(name, over(place)) };
    let turned = |nose_up_deg: f64| {
        let turn = Vector3::x() * (nose_up_deg - COVER.nose_up_deg).to_radians();
        head * Pose::rotation(turn) * head.inverse() * over(COVER)
    };
    let turn = |(name, nose_up_deg)| Stage {
        until_contact_n: Some(MOST_N),
        onward: true,
        ..at_head(name, turned(nose_up_deg))
    };
    let [.., (_, level_deg)] = TURNS;
    let release = Stage {
        until_contact_n: Some(TOUCH_N),
        onward: true,
        gripper: Some(GripperCommand::Open { opening_m: 0.04 }),
        retreat_m: 0.15,
        ..at_head("release", Translation3::new(0.0, 0.0, -DRAW_M) * turned(level_deg))
    };
    let mut stages = vec![
        pick(grasp.tool_on(now.vertices())),
        at_head("arrive", over(ARRIVE)),
        guarded("sink", BEHIND, PULL_N),
        guarded("hook", HOOK, PULL_N),
        guarded("cover", COVER, MOST_N),
    ];
    stages.extend(TURNS.map(turn));
    stages.push(release);
    Ok(Lesson {
        summary: "Pick a cap from the table and put it on a head.",
        frames: BTreeMap::from([("head".to_owned(), head)]),
        stages,
        set_right: Some(right),
        measure: Measure::Worn { tolerance_d: TOLERANCE_D },
    })
}
