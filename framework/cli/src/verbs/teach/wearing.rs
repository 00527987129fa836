//! Wearing: the cap comes onto the head with its nose up and is let go where the head bears it.

use super::{Lesson, TOLERANCE_D, grasp, missing, pick, stage};
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

/// It comes from behind with its nose up, so that the back of its hem passes the head first, ...
const ARRIVE: Over = Over { back_m: 0.012, height_m: 0.162, nose_up_deg: 12.0 };
/// ... sinks, ...
const LOWER: Over = Over { back_m: 0.012, height_m: 0.092, nose_up_deg: 8.0 };
/// ... down to here at the latest: how deep a crown sits differs by 12 mm (standard deviation)
/// from cap to cap, so the hand feels for the head, ...
const LOWEST: Over = Over { back_m: 0.006, height_m: -0.013, nose_up_deg: 8.0 };
/// ... which bears it from here on, newtons; an arm's force estimate tells so much from noise.
const TOUCH_N: f64 = 10.0;
/// Then it is turned about the middle of the head, which a cap slides around with the least
/// resistance, until its nose is up by so much, degrees; ...
const LEVEL_DEG: f64 = -2.0;
/// ... not against more than this, newtons.
const MOST_N: f64 = 20.0;
/// It is drawn down once more, metres, until the head bears [`TOUCH_N`] more, and let go.
const DRAW_M: f64 = 0.06;

/// The expert's key poses at the head.
pub(super) fn lesson(cell: &SimulatedCell, scene: &Scene) -> Result<Lesson> {
    let head = scene.head().ok_or_else(|| missing(scene, "head"))?.pose;
    let (grasp, now) = grasp(cell)?;
    let worn = grasp.tool_on(&cell.worn_vertices()?);
    let over = |place: Over| {
        let nose_up = place.nose_up_deg.to_radians();
        let turn = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), nose_up);
        let shift = Translation3::new(0.0, -place.back_m, place.height_m);
        head * Pose::from_parts(shift, turn) * head.inverse() * worn
    };
    let at_head = |name, pose| stage(name, RelativeTo::Frame("head".to_owned()), pose);
    let on_head = |name, place| at_head(name, over(place));
    let turn = (LEVEL_DEG - LOWEST.nose_up_deg).to_radians();
    let turn = Pose::rotation(Vector3::x() * turn);
    let level = head * turn * head.inverse() * over(LOWEST);
    let drawn = Translation3::new(0.0, 0.0, -DRAW_M) * level;
    Ok(Lesson {
        summary: "Pick a cap from the table and put it on a head.",
        frames: BTreeMap::from([("head".to_owned(), head)]),
        stages: vec![
            pick(grasp.tool_on(now.vertices())),
            on_head("middle", ARRIVE),
            Stage { until_contact_n: Some(TOUCH_N), ..on_head("lower", LOWER) },
            Stage { until_contact_n: Some(TOUCH_N), ..on_head("feel", LOWEST) },
            Stage { until_contact_n: Some(MOST_N), onward: true, ..at_head("level", level) },
            Stage {
                until_contact_n: Some(TOUCH_N),
                onward: true,
                gripper: Some(GripperCommand::Open { opening_m: 0.04 }),
                retreat_m: 0.15,
                ..at_head("release", drawn)
            },
        ],
        measure: Measure::Worn { tolerance_d: TOLERANCE_D },
    })
}
