//! Look whether it came out as it was shown. The hand goes back to where it waits, out of the
//! camera's view; the object is looked at and perceived as it was before, and so is the object of
//! the demonstration as it lay in the end. What lies otherwise is taken again.

use super::act::{Acted, Again};
use super::assignment::Assignment;
use super::bench::Bench;
use super::key_poses::Askew;
use super::observe::NOTHING;
use super::perceive::perceived;
use super::step::{Failed, StageEvent, Step};
use super::withdraw::withdrawn;
use crate::files::ShownResult;
use crate::plugins::Plugins;
use crate::transfer::Placement;
use bevy_ecs::prelude::*;
use nalgebra::{Point3, UnitQuaternion, Vector3};
use seeone_core::{Pose, Similarity};
use seeone_plugin::{CanonicalCloud, Observation};
use std::f64::consts::PI;

/// Whether the robot itself holds the object to lie as it was shown. Its verdict is its own: it
/// may be wrong either way.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
pub struct Checked {
    /// Whether it does.
    pub as_shown: bool,
}

/// What lies no farther than this from where it was shown, metres, and leans by no more than
/// this, degrees, is set right where it is; anything else is taken from there and brought again.
const ASKEW_M: f64 = 0.10;
const ASKEW_DEG: f64 = 45.0;

/// The point of the canonical cube by which places are compared: of one that is round, the only
/// one that is where it is whatever the perception takes for its front.
const MIDDLE: Point3<f64> = Point3::new(0.5, 0.5, 0.5);

/// How far an object lies from where that of the demonstration lay.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Off {
    /// Distance of the [`MIDDLE`]s, metres.
    metres: f64,
    /// What turns the up axis of the shown one's canonical state into that of this one's.
    lean: UnitQuaternion<f64>,
}

impl Off {
    /// Between two placements of the canonical state in one frame.
    fn between(shown: &Similarity, here: &Similarity) -> Self {
        let up = |placed: &Similarity| placed.isometry.rotation * Vector3::z();
        Self {
            metres: (shown * MIDDLE - here * MIDDLE).norm(),
            // Axes that are opposite have no one turn between them: any half turn will do.
            lean: UnitQuaternion::rotation_between(&up(shown), &up(here))
                .unwrap_or_else(|| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), PI)),
        }
    }

    fn degrees(&self) -> f64 {
        self.lean.angle().to_degrees()
    }

    /// For what lies where it was to be, and is to be set right there.
    fn askew(&self) -> Option<Askew> {
        let near = self.metres <= ASKEW_M && self.degrees() <= ASKEW_DEG;
        near.then_some(Askew { lean: self.lean })
    }

    fn is_within(&self, shown: &ShownResult) -> bool {
        self.metres <= shown.within_m && self.degrees() <= shown.within_deg
    }
}

/// Runs that have carried out what they were to do.
type Done = (Without<Failed>, Without<Again>);

pub(super) fn check(
    mut commands: Commands,
    mut bench: NonSendMut<Bench>,
    mut runs: Query<(Entity, &Assignment, &mut Acted), Done>,
) {
    for (run, assignment, mut acted) in &mut runs {
        let Some(shown) = &assignment.skill.result else { continue };
        let cancel = bench.cancel().clone();
        let (looked, seconds) = bench.timed(Step::Check, |plugins, _| {
            withdrawn(plugins, assignment, &cancel, &mut acted)?;
            off(plugins, assignment, shown)
        });
        if cancel.is_ordered() {
            let reason = looked.err().unwrap_or_default();
            commands.entity(run).insert(Failed { stage: Step::Check.name().into(), reason });
            continue;
        }
        let as_shown = looked.as_ref().is_ok_and(|off| off.is_within(shown));
        let askew = looked.as_ref().ok().and_then(Off::askew);
        let reason = match looked {
            Ok(off) => format!(
                "{:.0} mm and {:.0} degrees from where it was shown",
                off.metres * 1e3,
                off.degrees()
            ),
            Err(reason) => reason,
        };
        let (name, reason) = (Step::Check.name().into(), Some(reason));
        bench.tell(StageEvent { name, ok: as_shown, seconds, reason });
        commands.entity(run).insert(Checked { as_shown });
        if !as_shown && acted.tries < assignment.tries {
            commands.entity(run).insert(Again);
            if let Some(askew) = askew {
                commands.entity(run).insert(askew);
            }
        }
    }
}

/// Looks and compares.
fn off(plugins: &mut Plugins, assignment: &Assignment, shown: &ShownResult) -> Result<Off, String> {
    let cloud = assignment.result.clone().ok_or("the skill's result was not read")?;
    let camera_position = assignment.skill.demonstration.camera_position;
    let then = Observation { depth: None, cloud, camera_position };
    let now = plugins.camera.observe().map_err(|e| e.to_string())?;
    if now.cloud.is_empty() {
        return Err(NOTHING.into());
    }
    let then = perceived(plugins, &then).map_err(|e| format!("the demonstration: {e}"))?;
    let now = perceived(plugins, &now)?;
    let placed = |cloud: &CanonicalCloud, frame: &Pose| {
        let placement = Placement::new(plugins.alignment.as_ref(), cloud);
        let transform = placement.map_err(|e| e.to_string())?.global().transform;
        Ok::<_, String>(Similarity::from_isometry(frame.inverse(), 1.0) * transform)
    };
    let then = placed(&then, &assignment.skill.demonstration.frames[&shown.frame])?;
    let now = placed(&now, &assignment.frames[&shown.frame])?;
    Ok(Off::between(&then, &now))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Translation3, UnitQuaternion};

    #[test]
    fn a_shift_and_a_tilt_are_told_and_a_turn_about_the_up_axis_is_not() {
        let at = |x: f64, turn: UnitQuaternion<f64>| {
            let middle = MIDDLE.coords * 0.27;
            let to = Vector3::new(x, 0.0, 0.1) - turn * middle;
            Similarity::from_parts(Translation3::from(to), turn, 0.27)
        };
        let level = UnitQuaternion::identity();
        let about =
            |axis, degrees: f64| UnitQuaternion::from_axis_angle(&axis, degrees.to_radians());
        let shown = at(0.0, level);
        let tilted = Off::between(&shown, &at(0.02, about(Vector3::x_axis(), 9.0)));
        assert!((tilted.metres - 0.02).abs() < 1e-9 && (tilted.degrees() - 9.0).abs() < 1e-6);
        let turned = Off::between(&shown, &at(0.0, about(Vector3::z_axis(), 90.0)));
        assert!(turned.metres < 1e-9 && turned.degrees() < 1e-6, "{turned:?}");
        let over = Off::between(&shown, &at(0.0, about(Vector3::y_axis(), 180.0)));
        assert!((over.degrees() - 180.0).abs() < 1e-6, "{over:?}");
    }
}
