//! The command line.

use clap::{
    ArgMatches, Args, Command, FromArgMatches, Parser, Subcommand, ValueEnum, value_parser,
};
use seeone_plugin::Kind;
use seeone_runtime::files::Family;
use seeone_runtime::methods::parse_override;
use std::num::{NonZeroUsize, ParseFloatError, ParseIntError};
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
    /// How often the robot may look and reach for the object if its hand closes on nothing; a
    /// task says itself how often its steps are tried.
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = value_parser!(u64).range(1..=20))]
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
    /// for ever, and calls it a few microseconds faster.
    #[arg(
        long = "plugin-patience",
        value_name = "SECONDS",
        default_value = "60",
        allow_negative_numbers = true,
        value_parser = patience
    )]
    pub patience: Duration,
}

/// `run`.
#[derive(Clone, Debug, Args)]
pub struct RunArgs {
    /// Skill, robot, scene, methods.
    #[command(flatten)]
    pub cell: CellArgs,
    /// The object: a name from `objects list`, or a file from `objects import`.
    #[arg(long, value_name = "NAME|FILE")]
    pub object: Option<String>,
    /// Seed of the drop, of the camera's noise and of every other draw.
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
    /// Plan, but do not move.
    #[arg(long)]
    pub dry_run: bool,
    /// Print the outcome as one JSON object on standard output.
    #[arg(long)]
    pub json: bool,
    /// Folder for the recording, the picture and the table of the planned motion.
    #[arg(long, default_value = "out")]
    pub out: PathBuf,
}

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
    /// Keep every attempt in this file as it ends, and do not make again what is there: the same
    /// command goes on where it was stopped, and more --attempts add to it.
    #[arg(long, value_name = "FILE")]
    pub keep: Option<PathBuf>,
    /// Print the table as JSON on standard output.
    #[arg(long)]
    pub json: bool,
}

/// `teach`.
#[derive(Clone, Debug, Args)]
pub struct TeachArgs {
    /// The skill file to write; its cloud goes into a folder of its name beside it.
    pub skill: PathBuf,
    /// What is shown.
    #[arg(long, value_enum, default_value_t = Shown::Wearing)]
    pub show: Shown,
    /// The object that is shown.
    #[arg(long, default_value = "cap-train-077")]
    pub object: String,
    /// Seed of the drop and of the camera's noise.
    #[arg(long, default_value_t = 4)]
    pub seed: u64,
    /// The robot that shows it.
    #[arg(long, default_value = "robots/ur5-ag95-sim.toml")]
    pub robot: PathBuf,
    /// The scene it is shown in.
    #[arg(long, default_value = "scenes/head.toml")]
    pub scene: PathBuf,
}

/// What the scripted expert can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Shown {
    /// Putting a cap on the scene's head.
    Wearing,
    /// Hanging a cap on the scene's hook.
    Hanging,
}

/// `objects ...`.
#[derive(Debug, Subcommand)]
pub enum ObjectsAction {
    /// The generated objects with template and sets, a line each.
    List {
        /// As a JSON array, with measures.
        #[arg(long)]
        json: bool,
    },
    /// Turn a mesh into an object of the category.
    Import(ImportArgs),
    /// Draw an object.
    Show {
        /// A name from `objects list`, or a file from `objects import`.
        object: String,
        /// The PNG file to write.
        #[arg(long, default_value = "out/object.png")]
        out: PathBuf,
    },
    /// Draw contact sheets: all objects, worn, dropped, and seen by the depth camera.
    Sheet {
        /// Seed of the drops and of the camera's noise.
        #[arg(long, default_value_t = 1)]
        seed: u64,
        /// The folder for caps.png, canonical.png, drops.png and depth.png.
        #[arg(long, default_value = "out")]
        out: PathBuf,
    },
}

/// `objects import`.
#[derive(Clone, Debug, Args)]
pub struct ImportArgs {
    /// The mesh: OBJ.
    pub mesh: PathBuf,
    /// The mesh's axis that points up when the cap is worn: +x, -x, +y, -y, +z or -z.
    #[arg(long, allow_hyphen_values = true)]
    pub up: String,
    /// The mesh's axis along which the visor points; found when left out.
    #[arg(long, allow_hyphen_values = true)]
    pub front: Option<String>,
    /// Circumference of the head it fits, metres: gives the scale.
    #[arg(long, value_name = "METRES")]
    pub head_circumference: f64,
    /// The object file to write (TOML).
    #[arg(long)]
    pub out: PathBuf,
}

/// `data`.
#[derive(Clone, Debug, Args)]
pub struct DataArgs {
    /// Folder to write; whole shards already there are kept.
    #[arg(long)]
    pub out: PathBuf,
    /// Seed of every draw.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// A set (`train`, `wide`, `paper-40`, `validation`, `unseen`, `beanie`), a name, or a file
    /// from `objects import`; may be repeated.
    #[arg(long, default_values = ["train", "wide"])]
    pub objects: Vec<String>,
    /// Frames in all, shared evenly by the objects.
    #[arg(long, default_value_t = FRAMES, value_parser = frames)]
    pub frames: NonZeroUsize,
    /// Views of each moment, 1 to 4.
    #[arg(long, default_value_t = VIEWS, value_parser = views)]
    pub views: NonZeroUsize,
    /// What was made, as JSON.
    #[arg(long)]
    pub json: bool,
}

/// What to train.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Network {
    /// Observation -> canonical.
    Nst,
    /// Canonical -> features anywhere.
    Nse,
    /// One after the other.
    All,
}

/// `train`.
#[derive(Clone, Debug, Args)]
pub struct TrainArgs {
    /// Which network.
    pub network: Network,
    /// The training set.
    #[arg(long, default_value = "data/train")]
    pub data: PathBuf,
    /// Seed of the initial weights, of the order of samples and of every augmentation.
    #[arg(long, default_value_t = 1)]
    pub seed: u64,
    /// Folder under which `nst` and `nse` put their weights and cards.
    #[arg(long, default_value = "weights")]
    pub out: PathBuf,
    /// Share of the full number of samples, for a trial: 1 trains fully.
    #[arg(long, default_value_t = 1.0, allow_negative_numbers = true, value_parser = share)]
    pub share: f64,
}

/// The frame whose poses are given.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Frame {
    /// The flange, the URDF link `tool0`.
    Tool0,
    /// The tool link of the robot file.
    Tcp,
}

/// `ik`.
#[derive(Clone, Debug, Args)]
pub struct IkArgs {
    /// The robot file.
    #[arg(long, default_value = "robots/ur5-ag95-sim.toml")]
    pub robot: PathBuf,
    /// The targets (JSON).
    #[arg(long, value_name = "FILE", required_unless_present = "path")]
    pub targets: Option<PathBuf>,
    /// The targets are paths, each to be followed on one branch of the arm; named here, or by
    /// `--targets`.
    #[arg(long, value_name = "FILE", num_args = 0..=1)]
    pub path: Option<Option<PathBuf>>,
    /// The file to write; left out, the answers go to standard output.
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Start each target from the robot's home and not from the answer before it.
    #[arg(long)]
    pub from_home: bool,
    /// Which frame the poses are of.
    #[arg(long, value_enum, default_value_t = Frame::Tool0)]
    pub frame: Frame,
    /// With `--frame tcp`: how far the pads are apart, metres; they come forward as they close,
    /// and the tool with them.
    #[arg(long, value_name = "METRES", default_value_t = 0.0)]
    pub opening: f64,
    /// Keep away from what stands in this scene too, and not from the robot itself alone.
    #[arg(long, value_name = "FILE")]
    pub scene: Option<PathBuf>,
    /// Plugins from dynamic libraries.
    #[command(flatten)]
    pub libraries: LibraryArgs,
    /// Use another plugin, e.g. `kinematics=damped-least-squares`.
    #[arg(long = "method", value_name = "KIND=PLUGIN", value_parser = parse_override)]
    pub methods: Vec<(Kind, String)>,
    /// Seed of the solver's restarts.
    #[arg(long, default_value_t = 0)]
    pub seed: u64,
}

/// `new ...`.
#[derive(Debug, Subcommand)]
pub enum NewAction {
    /// A plugin: a crate that builds a dynamic library and passes its own tests.
    Plugin(NewPluginArgs),
    /// A skill, begun from the demonstration of another.
    Skill(NewSkillArgs),
    /// A robot file for an arm that a URDF describes.
    Robot(NewRobotArgs),
}

/// `new skill`.
#[derive(Clone, Debug, Args)]
pub struct NewSkillArgs {
    /// Its name: small letters, digits and hyphens.
    pub name: String,
    /// The folder to write into.
    #[arg(long, value_name = "FOLDER", default_value = "skills")]
    pub folder: PathBuf,
    /// The skill that it is begun from.
    #[arg(long, value_name = "FILE", default_value = "skills/cap-wearing.toml")]
    pub from: PathBuf,
}

/// `new robot`.
#[derive(Clone, Debug, Args)]
pub struct NewRobotArgs {
    /// Its name: small letters, digits and hyphens.
    pub name: String,
    /// The description of the arm with its gripper; copied into the folder unless it lies there.
    #[arg(long, value_name = "FILE")]
    pub urdf: PathBuf,
    /// The tool's link: z along the approach, y along the closing direction, between the pads.
    #[arg(long, value_name = "LINK", default_value = "tcp")]
    pub tool_link: String,
    /// The folder to write into.
    #[arg(long, value_name = "FOLDER", default_value = "robots")]
    pub folder: PathBuf,
}

/// `check`.
#[derive(Clone, Debug, Args)]
pub struct CheckArgs {
    /// The files.
    #[arg(required = true)]
    pub files: Vec<PathBuf>,
    /// Whether this robot reaches the poses of skills and tasks.
    #[arg(long, value_name = "FILE")]
    pub robot: Option<PathBuf>,
    /// Whether this scene has the frames of skills and tasks.
    #[arg(long, value_name = "FILE")]
    pub scene: Option<PathBuf>,
    /// As a JSON array of faults.
    #[arg(long)]
    pub json: bool,
}

/// `new plugin`.
#[derive(Clone, Debug, Args)]
pub struct NewPluginArgs {
    /// Its name, as it is chosen by `--method KIND=NAME`.
    pub name: String,
    /// What it does.
    #[arg(long, value_parser = kind)]
    pub kind: Kind,
    /// The folder to make; left out, one of its name.
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,
    /// Where this framework's sources lie.
    #[arg(long, value_name = "FOLDER", default_value = ".")]
    pub framework: PathBuf,
}

/// `plugins ...`.
#[derive(Debug, Subcommand)]
pub enum PluginsAction {
    /// What is built in, by kind; and which libraries of a folder are trusted, or why not.
    List {
        /// Folders to look for libraries in.
        folders: Vec<PathBuf>,
        /// As a JSON array.
        #[arg(long)]
        json: bool,
    },
    /// Try a dynamic library, trusted or not: what it offers, or why it cannot be served.
    ///
    /// It is loaded by another process, so that a library that ends its process is told like
    /// any other fault.
    Check {
        /// The library.
        library: PathBuf,
    },
    /// Loads a library unchecked, for `check` alone.
    #[command(hide = true)]
    Probe {
        /// The library.
        library: PathBuf,
    },
    /// Write the manifest of a dynamic library: from then on this very file is loaded.
    Trust {
        /// The library.
        library: PathBuf,
    },
}

/// Frames of a training set unless told otherwise.
const FRAMES: NonZeroUsize = NonZeroUsize::new(5600).expect("not zero");
/// Views of a moment unless told otherwise: more drops teach more than more views of one.
const VIEWS: NonZeroUsize = NonZeroUsize::new(2).expect("not zero");
/// Most views of a moment.
const MOST_VIEWS: usize = 4;

fn family(text: &str) -> Result<Family, String> {
    let known = Family::ALL.map(Family::name);
    let family = Family::ALL.into_iter().find(|family| family.name() == text);
    family.ok_or_else(|| format!("known: {}", known.join(", ")))
}

fn frames(text: &str) -> Result<NonZeroUsize, String> {
    let frames: usize = text.parse().map_err(|e: ParseIntError| e.to_string())?;
    NonZeroUsize::new(frames).ok_or_else(|| "a set of no frames teaches nothing".into())
}

fn views(text: &str) -> Result<NonZeroUsize, String> {
    let views: usize = text.parse().map_err(|e: ParseIntError| e.to_string())?;
    let some = NonZeroUsize::new(views).filter(|_| views <= MOST_VIEWS);
    some.ok_or_else(|| format!("not from 1 to {MOST_VIEWS}"))
}

fn kind(text: &str) -> Result<Kind, String> {
    let known = Kind::ALL.map(Kind::name).join(", ");
    text.parse().map_err(|()| format!("not one of {known}"))
}

fn patience(text: &str) -> Result<Duration, String> {
    let seconds: f64 = text.parse().map_err(|e: ParseFloatError| e.to_string())?;
    let some = (0.0..=86_400.0).contains(&seconds).then(|| Duration::from_secs_f64(seconds));
    some.ok_or_else(|| "not from 0 to 86400".into())
}

fn share(text: &str) -> Result<f64, String> {
    let share: f64 = text.parse().map_err(|e: ParseFloatError| e.to_string())?;
    // A comparison that NaN fails.
    if share > 0.0 && share <= 10.0 { Ok(share) } else { Err("not above 0 and up to 10".into()) }
}
