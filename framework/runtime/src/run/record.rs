//! Write the run down.

use super::act::Acted;
use super::assignment::Assignment;
use super::bench::Bench;
use super::judge::Judged;
use super::perceive::Perceived;
use super::plan::Planned;
use super::step::{Failed, Step};
use super::transfer::Transferred;
use crate::record::{Record, write};
use bevy_ecs::prelude::*;
use std::path::PathBuf;

/// Where the recording of a run lies.
#[derive(Component, Clone, Debug, PartialEq, Eq)]
pub(super) struct Recorded(pub(super) PathBuf);

/// Everything that a run may have left.
type Left<'a> = (
    Entity,
    &'a Assignment,
    Option<&'a Perceived>,
    Option<&'a Transferred>,
    Option<&'a Planned>,
    Option<&'a Acted>,
    Option<&'a Judged>,
    Option<&'a Failed>,
);

pub(super) fn record(mut commands: Commands, mut bench: NonSendMut<Bench>, runs: Query<Left>) {
    for (run, assignment, perceived, transferred, planned, acted, judged, failed) in &runs {
        let Some(path) = &assignment.recording else { continue };
        let record = Record {
            assignment,
            perceived,
            transferred,
            planned,
            acted,
            verdict: judged.map(|judged| &judged.0),
            failed,
            stages: &bench.events.clone(),
        };
        match bench.step(Step::Record, |_| write(path, &record).map_err(|e| e.to_string())) {
            Ok(()) => commands.entity(run).insert(Recorded(path.clone())),
            // What went wrong first is what is told.
            Err(_) if failed.is_some() => continue,
            Err(fault) => commands.entity(run).insert(fault),
        };
    }
}
