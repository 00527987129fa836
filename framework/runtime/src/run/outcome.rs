//! What is told of a run.

use super::act::Acted;
use super::assignment::Assignment;
use super::bench::Bench;
use super::record::Recorded;
use super::step::{Failed, StageEvent, Step};
use seeone_plugin::{Kind, Verdict};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// What is told of a run: the one object that `run --json` prints.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// The skill's name.
    pub skill: String,
    /// The object's name.
    pub object: String,
    /// The robot's name.
    pub robot: String,
    /// The seed.
    pub seed: u64,
    /// Which plugin did what.
    #[serde(serialize_with = "methods", deserialize_with = "read_methods")]
    pub methods: Vec<(Kind, String)>,
    /// How often the robot looked and reached for the object; zero after a dry run.
    pub tries: usize,
    /// The step of the run, or the stage of the skill, at which it ended early.
    pub failed_at: Option<String>,
    /// Whether the robot itself, which looked when it was done, holds the object to lie as it was
    /// shown; `None` where it did not look.
    pub as_shown: Option<bool>,
    /// Held after the lift, in any try; `None` when nobody could tell, as after a dry run.
    pub grasped: Option<bool>,
    /// The same of the first try.
    pub grasped_at_first: Option<bool>,
    /// Every stage carried out, and within the skill's tolerance; `None` when nobody could tell.
    pub success: Option<bool>,
    /// Mean vertex distance to the worn state, metres.
    pub error_m: Option<f64>,
    /// The same as a share of the object's diameter.
    pub error_d: Option<f64>,
    /// Angle between the worn and the reached up axis, degrees.
    pub tilt_deg: Option<f64>,
    /// The part of it that is the brim's: up positive, degrees.
    pub nose_up_deg: Option<f64>,
    /// Angle about the up axis between worn and reached, degrees.
    pub yaw_deg: Option<f64>,
    /// Why it failed, or by how much it succeeded.
    pub reason: String,
    /// How each step and each stage of the skill ended, in order, those of every try. A try that
    /// closed on nothing is told with `ok = false` in a run that may succeed all the same.
    pub stages: Vec<StageEvent>,
    /// Time of each step, in all tries together, by the clock that was handed in, milliseconds.
    #[serde(serialize_with = "timings", deserialize_with = "read_timings")]
    pub timings_ms: Vec<(Step, f64)>,
    /// Where the recording lies.
    pub recording: Option<PathBuf>,
}

impl Outcome {
    pub(super) fn new(
        assignment: &Assignment,
        bench: &Bench,
        verdict: Option<&Verdict>,
        acted: Option<&Acted>,
        as_shown: Option<bool>,
        failed: Option<&Failed>,
        recorded: Option<&Recorded>,
    ) -> Self {
        let reason = match (failed, verdict) {
            (Some(failed), _) => format!("{}: {}", failed.stage, failed.reason),
            (None, Some(verdict)) => verdict.reason.clone(),
            (None, None) if assignment.dry_run => "planned, not carried out".into(),
            (None, None) => "carried out; nobody can judge this cell".into(),
        };
        let methods = assignment.methods.iter().map(|(kind, name)| (kind, name.to_owned()));
        Self {
            skill: assignment.skill.name.clone(),
            object: assignment.object.clone(),
            robot: assignment.robot_name.clone(),
            seed: assignment.seed,
            methods: methods.collect(),
            tries: acted.map_or(0, |acted| acted.tries),
            failed_at: failed.map(|failed| failed.stage.clone()),
            as_shown,
            grasped: verdict.map(|verdict| verdict.grasped),
            grasped_at_first: acted.and_then(|acted| acted.grasped_at_first),
            success: verdict.map(|verdict| verdict.success),
            error_m: verdict.and_then(|verdict| verdict.error_m),
            error_d: verdict.and_then(|verdict| verdict.error_d),
            tilt_deg: verdict.and_then(|verdict| verdict.tilt_deg),
            nose_up_deg: verdict.and_then(|verdict| verdict.nose_up_deg),
            yaw_deg: verdict.and_then(|verdict| verdict.yaw_deg),
            reason,
            stages: bench.events.clone(),
            timings_ms: bench.timings_ms.clone(),
            recording: recorded.map(|recorded| recorded.0.clone()),
        }
    }
}

fn methods<S: Serializer>(methods: &[(Kind, String)], to: S) -> Result<S::Ok, S::Error> {
    to.collect_map(methods.iter().map(|(kind, name)| (kind.name(), name)))
}

fn timings<S: Serializer>(timings: &[(Step, f64)], to: S) -> Result<S::Ok, S::Error> {
    to.collect_map(timings.iter().map(|(step, ms)| (step.name(), ms)))
}

fn read_methods<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<(Kind, String)>, D::Error> {
    let by_name = BTreeMap::<String, String>::deserialize(from)?;
    let mut methods = by_name
        .into_iter()
        .map(|(kind, name)| {
            let unknown = || D::Error::custom(format!("there is no kind \"{kind}\""));
            Ok((kind.parse().map_err(|()| unknown())?, name))
        })
        .collect::<Result<Vec<(Kind, String)>, D::Error>>()?;
    methods.sort_by_key(|(kind, _)| *kind);
    Ok(methods)
}

fn read_timings<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<(Step, f64)>, D::Error> {
    let by_name = BTreeMap::<String, f64>::deserialize(from)?;
    if let Some(name) = by_name.keys().find(|name| Step::ALL.iter().all(|s| s.name() != *name)) {
        return Err(D::Error::custom(format!("there is no step \"{name}\"")));
    }
    let taken = |step: Step| by_name.get(step.name()).map(|ms| (step, *ms));
    Ok(Step::ALL.into_iter().filter_map(taken).collect())
}
