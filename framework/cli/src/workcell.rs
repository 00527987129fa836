//! One attempt: the files, the simulated cell and the plugins brought together.

use crate::args::CellArgs;
use crate::builtin;
use crate::disturbance::Disturbance;
use crate::faults::Faults;
use crate::oracle::{self, Oracle};
use crate::simulated::SimulatedCell;
use anyhow::{Context, Result};
use seeone_core::Diagnostic;
use seeone_core::robot::RobotModel;
use seeone_plugin::Kind;
use seeone_runtime::files::{RobotFile, Scene, Skill};
use seeone_runtime::methods::Methods;
use seeone_runtime::plugins::{Cell, Plugins, configuration};
use seeone_runtime::registry::Registry;
use seeone_runtime::run::{Assignment, Finished, Hooks};
use seeone_sim::object::Object;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// What every attempt of one command shares.
pub struct Workcell {
    /// Every plugin there is.
    pub registry: Registry,
    /// The skill.
    pub skill: Skill,
    /// The scene.
    pub scene: Scene,
    /// The robot file's name for the report.
    pub robot_name: String,
    /// The robot.
    pub robot: RobotModel,
    /// Which plugin does what.
    pub methods: Methods,
    tries: usize,
    disturbance: Disturbance,
    oracles: Vec<Oracle>,
    config: BTreeMap<Kind, toml::Table>,
    provenance: BTreeMap<String, String>,
    libraries: Vec<PathBuf>,
}

/// How one attempt is to be made.
pub struct Attempt {
    /// The seed of every draw.
    pub seed: u64,
    /// Whether to stop after planning.
    pub dry_run: bool,
    /// Where to record it, if at all.
    pub recording: Option<PathBuf>,
}

impl Workcell {
    /// Reads and checks everything the command names.
    ///
    /// # Errors
    /// Every fault found in the first file that has any, an unknown method, a plugin that
    /// is not trusted.
    pub fn open(args: &CellArgs) -> Result<Self> {
        let mut registry = builtin::registry();
        builtin::load(&mut registry, &args.libraries)?;
        let known = registry.known();
        let skill = Skill::read(&args.skill, &known).map_err(Faults)?;
        let scene = Scene::read(&args.scene, &known).map_err(Faults)?;
        let robot_file = RobotFile::read(&args.robot, &known).map_err(Faults)?;
        let robot = robot_file.model()?;
        let methods = Methods::resolve(&skill, &scene, &robot_file, &args.methods, &registry)?;
        let config = configuration(&scene, &robot_file);
        let provenance = builtin::provenance(&methods)?;
        Ok(Self {
            registry,
            skill,
            scene,
            robot_name: robot_file.name,
            robot,
            methods,
            tries: args.tries as usize,
            disturbance: Disturbance::default(),
            oracles: Vec::new(),
            config,
            provenance,
            libraries: args.libraries.plugins.clone(),
        })
    }

    /// The same, made worse.
    #[must_use]
    pub fn disturbed(mut self, disturbance: &Disturbance) -> Self {
        self.disturbance = *disturbance;
        disturbance.camera(self.config.entry(Kind::Camera).or_default());
        self
    }

    /// The same, with truth in the place of what a robot finds out.
    #[must_use]
    pub fn consulting(mut self, oracles: &[Oracle]) -> Self {
        self.oracles = oracles.to_vec();
        self
    }

    /// Makes one attempt in a cell into which `object` has been dropped.
    ///
    /// # Errors
    /// When a plugin cannot be built or the skill does not fit the scene. Whatever goes
    /// wrong in the run itself is told in its outcome.
    pub fn attempt(
        &self,
        cell: &SimulatedCell,
        object: &Object,
        attempt: Attempt,
        hooks: Hooks,
    ) -> Result<Finished> {
        let built = Cell {
            config: &self.config,
            root: Path::new("."),
            seed: attempt.seed,
            robot: &self.robot,
            world: Some(cell.world()),
        };
        let judge = Box::new(cell.judge());
        let plugins = Plugins::build(&self.registry, &self.methods, &built, Some(judge))?;
        let plugins = oracle::consult(&self.oracles, plugins, cell, &self.skill)?;
        let skill = self.skill.clone();
        let scene = self.disturbance.scene(&self.scene, attempt.seed);
        let mut assignment =
            Assignment::new(skill, scene, self.robot.clone(), self.methods.clone())?;
        assignment.object = object.name().to_owned();
        assignment.robot_name.clone_from(&self.robot_name);
        assignment.seed = attempt.seed;
        assignment.tries = self.tries;
        assignment.dry_run = attempt.dry_run;
        assignment.recording = attempt.recording;
        assignment.provenance.clone_from(&self.provenance);
        Ok(seeone_runtime::run::run(assignment, plugins, hooks))
    }

    /// What the outcome of an attempt on one of `objects` depends on besides its seed, in
    /// short: two evaluations of the same fingerprint make the same attempts.
    ///
    /// # Errors
    /// When a file that was just read can be read no more.
    pub fn fingerprint(&self, objects: &str) -> Result<String, Diagnostic> {
        let mut hasher = blake3::Hasher::new();
        let parts = (&self.skill, &self.scene, &self.robot, &self.methods, &self.config);
        hasher.update(
            format!("{parts:?} {} {:?} {:?}", self.tries, self.disturbance, self.provenance)
                .as_bytes(),
        );
        hasher.update(format!("{:?} {:?}", self.disturbance, self.oracles).as_bytes());
        hasher.update(objects.as_bytes());
        let object_file = Some(Path::new(objects)).filter(|path| path.is_file());
        let result = self.skill.result.as_ref().map(|result| result.cloud.as_path());
        let files = [Some(self.skill.demonstration.cloud.as_path()), result, object_file];
        for file in files.into_iter().chain(self.libraries.iter().map(|l| Some(l.as_path()))) {
            let Some(file) = file else { continue };
            let bytes = fs::read(file).map_err(|e| {
                Diagnostic::new("F001", format!("cannot read the file: {e}")).in_file(file)
            })?;
            hasher.update(blake3::hash(&bytes).as_bytes());
        }
        Ok(hasher.finalize().to_hex().to_string())
    }

    /// Drops `object` into the scene.
    ///
    /// # Errors
    /// As [`SimulatedCell::drop`].
    pub fn drop(&self, object: &Object, seed: u64) -> Result<SimulatedCell> {
        let scene = self.disturbance.scene(&self.scene, seed);
        SimulatedCell::drop(&scene, object.clone(), seed).context("the simulated cell")
    }
}
