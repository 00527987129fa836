//! The command line; a file a verb.

mod check;
mod data;
mod eval;
mod ik;
mod new;
mod objects;
mod plugins;
mod run;
mod teach;
mod train;

pub use check::CheckArgs;
pub use data::DataArgs;
pub use eval::{
    EvalArgs, EvalGraspsArgs, EvalPart, EvalPerceptionArgs, EvalReconstructionArgs, EvalSkillArgs,
    Series,
};
pub use ik::{Frame, IkArgs};
pub use new::{NewAction, NewPluginArgs, NewRobotArgs, NewSkillArgs};
pub use objects::{ImportArgs, ObjectsAction};
pub use plugins::PluginsAction;
pub use run::RunArgs;
pub use teach::{Shown, TeachArgs};
pub use train::{Network, TrainArgs};

use clap::{Args, Parser, Subcommand, value_parser};
use seeone_plugin::Kind;
use seeone_runtime::files::Family;
use seeone_runtime::methods::parse_override;
use std::num::ParseFloatError;
use std::path::PathBuf;
use std::time::Duration;

/// See one, do many: a robot watches one manipulation of one deformable object and does
/// it on every other object of that category.
///
/// Exit status: 0 success; 1 the attempt was made and failed, or a check found faults;
/// 2 something given was wrong; 3 a fault of the program; 130 interrupted.
#[derive(Debug, Parser)]
#[command(name = "seeone", version, propagate_version = true)]
pub struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub verb: Verb,
}

/// The verbs.
#[derive(Debug, Subcommand)]
pub enum Verb {
    /// Run a skill once: look, perceive, encode, transfer, plan, act, judge. Or a task of skills.
    Run(RunArgs),
    /// Run a skill many times over seeds and objects and report rates with intervals.
    Eval(EvalArgs),
    /// Record a demonstration in the simulated cell into a skill file.
    Teach(TeachArgs),
    /// Objects of a category: list, import, show.
    Objects {
        /// What to do with them.
        #[command(subcommand)]
        action: ObjectsAction,
    },
    /// Make a training set: objects dropped, seen and labelled.
    Data(DataArgs),
    /// Train the networks.
    Train(TrainArgs),
    /// Answer a file of poses, or of paths of poses, with joint positions.
    ///
    /// Targets are a JSON array of {"id", "pose"}, a pose four rows of four numbers: the frame in
    /// the robot's base link, metres. Each is answered, in order, by {"id", "q", "status",
    /// "time_us", "position_error_m", "rotation_error_rad", "collision", "reason"}; "q" is null
    /// unless the status is "solved". Paths are an array of {"id", "poses"}, 125 poses a second,
    /// each answered by {"id", "q", "fraction", "reason"}.
    ///
    /// Exit status 0 once everything is answered, whatever the answers say.
    Ik(IkArgs),
    /// Begin a plugin, which passes its tests as it is, or a skill or a robot, which pass `check`.
    New {
        /// What to begin.
        #[command(subcommand)]
        action: NewAction,
    },
    /// Check skill, task, scene, robot, object, cloud and weights files, and trusted libraries.
    Check(CheckArgs),
    /// Print the JSON Schema of a kind of file, for editors.
    Schema {
        /// The kind of file: skill, task, scene or robot.
        #[arg(value_parser = family)]
        kind: Family,
    },
    /// Plugins: list what there is, check or trust a dynamic library.
    Plugins {
        /// What to do with them.
        #[command(subcommand)]
        action: PluginsAction,
    },
}

/// What a run or an evaluation is made of.
#[derive(Clone, Debug, Args)]
pub struct CellArgs {
    /// The skill file; `run` takes a task file, too.
    pub skill: PathBuf,
    /// The robot file.
    #[arg(long, default_value = "robots/ur5-ag95-sim.toml")]
    pub robot: PathBuf,
    /// The scene file.
    #[arg(long, default_value = "scenes/head.toml")]
    pub scene: PathBuf,
    /// Use another plugin of a kind, e.g. `transfer=unchanged`; may be repeated.
    #[arg(long = "method", value_name = "KIND=PLUGIN", value_parser = parse_override)]
    pub methods: Vec<(Kind, String)>,
    /// How often the robot may look and reach for the object if a try does not come out; a
    /// task says itself how often its steps are tried.
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = value_parser!(u64).range(1..=20))]
    pub tries: u64,
    /// Plugins from dynamic libraries.
    #[command(flatten)]
    pub libraries: LibraryArgs,
}

/// Plugins from dynamic libraries.
#[derive(Clone, Debug, Args)]
pub struct LibraryArgs {
    /// Load a trusted dynamic library and let its plugins serve their kinds; may be repeated.
    #[arg(long = "plugin", value_name = "PATH")]
    pub plugins: Vec<PathBuf>,
    /// Leave a loaded plugin alone that has given no sign of life for so many seconds; 0 waits
    /// for ever, and calls it a little faster.
    #[arg(
        long = "plugin-patience",
        value_name = "SECONDS",
        default_value = "60",
        allow_negative_numbers = true,
        value_parser = patience
    )]
    pub patience: Duration,
}

fn family(text: &str) -> Result<Family, String> {
    let known = Family::ALL.map(Family::name);
    let family = Family::ALL.into_iter().find(|family| family.name() == text);
    family.ok_or_else(|| format!("known: {}", known.join(", ")))
}

fn patience(text: &str) -> Result<Duration, String> {
    let seconds: f64 = text.parse().map_err(|e: ParseFloatError| e.to_string())?;
    let some = (0.0..=86_400.0).contains(&seconds).then(|| Duration::from_secs_f64(seconds));
    some.ok_or_else(|| "not from 0 to 86400".into())
}
