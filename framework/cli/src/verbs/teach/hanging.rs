//! Hanging: the cap is held by its visor, which points up, and its opening faces the wall. The
//! peg goes in below the front panel, which then comes down on it.

use super::{Lesson, grasp, missing, pick};
use crate::simulated::SimulatedCell;
use anyhow::{Result, anyhow};
use nalgebra::{Point3, Rotation3, Translation3, UnitQuaternion, Vector3};
use seeone_core::{Peg, Pose};
use seeone_plugin::{GripperCommand, Measure};
use seeone_runtime::files::{RelativeTo, Scene, Stage};
use seeone_sim::{Object, Region};
use std::collections::BTreeMap;

/// The visor leans away from the wall by so much, degrees: a hand that holds it has no room
/// between an upright one and the wall.
const LEAN_DEG: f64 = 30.0;
/// The hem above the visor is brought so near to the peg's tip, metres: then the peg ends in
/// the dome.
const SHORT_OF_TIP_M: f64 = 0.052;
/// It comes along the peg from so far out, metres, and ...
const OUT_M: f64 = 0.13;
/// ... so high over the peg's middle line, metres.
const HIGH_M: f64 = 0.035;
/// The hand then goes down until the peg bears this load, newtons, or ...
const CONTACT_N: f64 = 10.0;
/// ... the hem would be so far below the peg's middle line, metres: how far the hem lies over
/// the back of the object differs by 60 mm between caps and hats with a brim all around.
const LOWEST_M: f64 = -0.080;

/// The expert's key poses at the hook.
pub(super) fn lesson(cell: &SimulatedCell, scene: &Scene) -> Result<Lesson> {
    let hook = scene.hook().ok_or_else(|| missing(scene, "hook"))?;
    let (grasp, now) = grasp(cell)?;
    let object = now.object();
    let held = grasp.tool_on(object.mesh().vertices());
    let hem = front_of_hem(object).ok_or_else(|| anyhow!("{} has no hem", object.name()))?;
    let turn = opening_to_wall();
    let inside = Vector3::y() * (hook.peg.tip().y - SHORT_OF_TIP_M);
    let inside = inside + Vector3::z() * (inside.y * Peg::axis().z / Peg::axis().y);
    let at = |offset: Vector3<f64>| {
        let place = Translation3::from(inside + offset - turn * hem.coords);
        hook.pose * Pose::from_parts(place, turn) * held
    };
    let on_hook =
        |name, offset| Stage::through(name, RelativeTo::Frame("hook".to_owned()), at(offset));
    let high = Vector3::z() * HIGH_M;
    Ok(Lesson {
        summary: "Pick a cap from the table and hang it on a hook.",
        frames: BTreeMap::from([("hook".to_owned(), hook.pose)]),
        stages: vec![
            pick(grasp.tool_on(now.vertices())),
            on_hook("before", high + Peg::axis() * OUT_M),
            on_hook("over", high),
            Stage {
                until_contact_n: Some(CONTACT_N),
                gripper: Some(GripperCommand::Open { opening_m: 0.04 }),
                retreat_m: 0.15,
                ..on_hook("release", Vector3::z() * LOWEST_M)
            },
        ],
        set_right: None,
        measure: Measure::Hung,
    })
}

/// The middle of the hem's front, under the visor, in the object frame, metres.
fn front_of_hem(object: &Object) -> Option<Point3<f64>> {
    let vertices = object.mesh().vertices();
    let hem = object.vertices_of(Region::Hem).into_iter().map(|v| vertices[v]);
    hem.max_by(|a, b| a.y.total_cmp(&b.y))
}

/// Object frame -> hook frame: the visor up and leaning out, the crown away from the wall.
fn opening_to_wall() -> UnitQuaternion<f64> {
    let (lean, level) = LEAN_DEG.to_radians().sin_cos();
    let visor = Vector3::new(0.0, lean, level);
    let crown = Vector3::new(0.0, level, -lean);
    let axes = [visor.cross(&crown), visor, crown];
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_basis_unchecked(&axes))
}
