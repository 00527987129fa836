//! See how it ended. Every run is judged that was to move, however it failed: an object
//! that was never taken is not grasped. One that was interrupted is not judged.

use super::act::{Acted, Snapshot};
use super::assignment::Assignment;
use super::bench::Bench;
use super::schedule::leave;
use super::step::{Failed, Step};
use bevy_ecs::prelude::*;
use seeone_plugin::Verdict;

/// The world's verdict.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct Judged(pub Verdict);

pub(super) fn judge(
    mut commands: Commands,
    mut bench: NonSendMut<Bench>,
    mut runs: Query<(Entity, &Assignment, Option<&mut Acted>, Option<&Failed>)>,
) {
    for (run, assignment, mut acted, failed) in &mut runs {
        if assignment.dry_run || bench.plugins.judge.is_none() {
            continue;
        }
        let grasped = acted.as_ref().and_then(|acted| acted.grasped).unwrap_or(false);
        let judged = bench.step(Step::Judge, |plugins| {
            let judge = plugins.judge.as_mut().ok_or("nobody can judge this cell")?;
            let verdict =
                judge.judge(&assignment.skill.measure, grasped).map_err(|e| e.to_string())?;
            if let Some(acted) = &mut acted {
                let time_s = acted.end_s();
                acted.object.push(Snapshot { time_s, vertices: judge.object() });
            }
            // An object that the hand lost on the way may lie where it should; it was not
            // put there.
            let success = verdict.success && failed.is_none();
            Ok(Judged(Verdict { success, ..verdict }))
        });
        match (judged, failed) {
            // What went wrong first is what is told.
            (Err(_), Some(_)) => {}
            (judged, _) => leave(&mut commands, run, judged),
        }
    }
}
