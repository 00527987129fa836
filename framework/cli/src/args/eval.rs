//! `eval`: a skill many times, or a part alone.

use super::CellArgs;
use crate::disturbance::Disturbance;
use crate::oracle::Oracle;
use clap::{ArgMatches, Args, Command, FromArgMatches, Subcommand, value_parser};
use std::ops::Range;
use std::path::PathBuf;

/// The most attempts of one evaluation: more than that is a slip of the finger.
const MOST_ATTEMPTS: u64 = 1 << 20;
/// So that the last attempt has a seed as well.
const LAST_FIRST_SEED: u64 = u64::MAX - MOST_ATTEMPTS;

/// `eval`: of a skill, or of a part alone.
#[derive(Clone, Debug)]
pub enum EvalArgs {
    /// Many attempts with a skill.
    Skill(EvalSkillArgs),
    /// A part.
    Part(EvalPart),
}

/// What is evaluated alone.
#[derive(Clone, Debug, Subcommand)]
pub enum EvalPart {
    /// Canonical coordinates told by the perception, against the truth of a set of frames.
    Perception(EvalPerceptionArgs),
    /// The canonical shape that the encoding knows, as a surface, against the truth.
    Reconstruction(EvalReconstructionArgs),
    /// Grasps told by perception and transfer, against the expert's on the true shape.
    Grasps(EvalGraspsArgs),
}

// By hand, because a derived one wants the skill's arguments beside the subcommand's.
impl Args for EvalArgs {
    fn augment_args(command: Command) -> Command {
        EvalPart::augment_subcommands(EvalSkillArgs::augment_args(command))
            .args_conflicts_with_subcommands(true)
            .subcommand_negates_reqs(true)
            .subcommand_required(false)
            .arg_required_else_help(false)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for EvalArgs {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        if matches.subcommand_name().is_some() {
            EvalPart::from_arg_matches(matches).map(Self::Part)
        } else {
            EvalSkillArgs::from_arg_matches(matches).map(Self::Skill)
        }
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// `eval perception`.
#[derive(Clone, Debug, Args)]
pub struct EvalPerceptionArgs {
    /// A set of objects whose frames lie in `data/SET`.
    #[arg(long, value_name = "SET", default_value = "unseen")]
    pub objects: String,
    /// The frames, if they lie elsewhere.
    #[arg(long, value_name = "FOLDER")]
    pub data: Option<PathBuf>,
    /// The weights.
    #[arg(long, value_name = "FOLDER", default_value = "plugins/nst/weights")]
    pub weights: PathBuf,
    /// Ask the refiner once, as the paper reads its network.
    #[arg(long)]
    pub one_pass: bool,
    /// Write the figures into the weights' card, under the name of the set.
    #[arg(long, conflicts_with = "one_pass")]
    pub record: bool,
    /// Print the figures as JSON on standard output.
    #[arg(long)]
    pub json: bool,
}

/// `eval reconstruction`.
#[derive(Clone, Debug, Args)]
pub struct EvalReconstructionArgs {
    /// A set of objects whose frames lie in `data/SET`.
    #[arg(long, value_name = "SET", default_value = "unseen")]
    pub objects: String,
    /// The frames, if they lie elsewhere.
    #[arg(long, value_name = "FOLDER")]
    pub data: Option<PathBuf>,
    /// So many of the frames that show an object at rest, evenly spread.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = value_parser!(u64).range(1..))]
    pub frames: u64,
    /// The perception's weights.
    #[arg(long, value_name = "FOLDER", default_value = "plugins/nst/weights")]
    pub perception: PathBuf,
    /// The encoding's weights.
    #[arg(long, value_name = "FOLDER", default_value = "plugins/nse/weights")]
    pub encoding: PathBuf,
    /// Print the figures as JSON on standard output.
    #[arg(long)]
    pub json: bool,
}

/// `eval SKILL`.
#[derive(Clone, Debug, Args)]
pub struct EvalSkillArgs {
    /// Which attempts.
    #[command(flatten)]
    pub series: Series,
    /// Keep every attempt in this file as it ends, and do not make again what is there: the same
    /// command goes on where it was stopped, and more --attempts add to it.
    #[arg(long, value_name = "FILE")]
    pub keep: Option<PathBuf>,
}

/// `eval grasps`.
#[derive(Clone, Debug, Args)]
pub struct EvalGraspsArgs {
    /// Which attempts: what is told in the first look of each counts, and nothing moves.
    #[command(flatten)]
    pub series: Series,
}

/// Many attempts with one skill.
#[derive(Clone, Debug, Args)]
pub struct Series {
    /// Skill, robot, scene, methods.
    #[command(flatten)]
    pub cell: CellArgs,
    /// A set (`unseen`, `validation`, `train`, `paper-40`, `beanie`), a name, or a file from
    /// `objects import`.
    #[arg(long, default_value = "unseen")]
    pub objects: String,
    /// Number of attempts; attempt i uses seed i and takes the objects in turn.
    #[arg(long, default_value_t = 40, value_parser = value_parser!(u64).range(1..=MOST_ATTEMPTS))]
    pub attempts: u64,
    /// First seed.
    #[arg(long, default_value_t = 0, value_parser = value_parser!(u64).range(..=LAST_FIRST_SEED))]
    pub first_seed: u64,
    /// Attempts at the same time; the outcome does not depend on it.
    #[arg(long, default_value_t = 2)]
    pub jobs: usize,
    /// What is made worse.
    #[command(flatten)]
    pub disturbance: Disturbance,
    /// Let the simulated cell tell this instead of the robot's finding it out; may be repeated.
    #[arg(long = "oracle", value_name = "WHAT")]
    pub oracles: Vec<Oracle>,
    /// Print the table as JSON on standard output.
    #[arg(long)]
    pub json: bool,
}

impl Series {
    /// The seeds of the attempts.
    pub fn seeds(&self) -> Range<u64> {
        self.first_seed..self.first_seed + self.attempts
    }
}
