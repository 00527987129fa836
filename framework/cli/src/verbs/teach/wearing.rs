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
const LOWER: Over = Over { back_m: 0.012, height_m: 0.092, nose_up_deg: 6.0 };
/// ... and is let go here at the latest: how deep a crown sits differs by 12 mm (standard
/// deviation) from cap to cap, so the hand feels for the head. The nose is pulled down on the
/// way: a hem that keeps its length stays where it was drawn to, and let go level, caps sit
/// back on the head.
const LOWEST: Over = Over { back_m: 0.0, height_m: -0.013, nose_up_deg: -8.0 };
/// It is let go as soon as the head bears so much, newtons: pulled on as a person would, and
/// enough for an arm's force estimate to tell from noise.
const CONTACT_N: f64 = 20.0;

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
    let on_head = |name, place| stage(name, RelativeTo::Frame("head".to_owned()), over(place));
    Ok(Lesson {
        summary: "Pick a cap from the table and put it on a head.",
        frames: BTreeMap::from([("head".to_owned(), head)]),
        stages: vec![
            pick(grasp.tool_on(now.vertices())),
            on_head("middle", ARRIVE),
            on_head("lower", LOWER),
            Stage {
                until_contact_n: Some(CONTACT_N),
                gripper: Some(GripperCommand::Open { opening_m: 0.04 }),
                retreat_m: 0.15,
                ..on_head("release", LOWEST)
            },
        ],
        measure: Measure::Worn { tolerance_d: TOLERANCE_D },
    })
}
