//! What every run of a task shares, and the simulated cell around it: objects are dropped into
//! it one after another, and the robot stays.

use crate::args::CellArgs;
use crate::faults::Faults;
use crate::simulated::SimulatedCell;
use crate::{builtin, files, objects};
use anyhow::{Context, Result};
use seeone_core::Diagnostic;
use seeone_core::robot::RobotModel;
use seeone_plugin::Kind;
use seeone_runtime::files::{RobotFile, Scene, SkillUse, Task};
use seeone_runtime::methods::Methods;
use seeone_runtime::plugins::{self, Plugins, configuration};
use seeone_runtime::registry::Registry;
use seeone_runtime::run::Assignment;
use seeone_runtime::task;
use seeone_sim::object::Object;
use std::collections::BTreeMap;
use std::path::Path;
use std::rc::Rc;

/// The files of a task, read and checked, with every plugin there is.
pub struct Site {
    /// The task.
    pub task: Task,
    /// The scene.
    pub scene: Scene,
    /// The robot file.
    pub robot_file: RobotFile,
    registry: Registry,
    robot: RobotModel,
    overrides: Vec<(Kind, String)>,
    config: BTreeMap<Kind, toml::Table>,
}

impl Site {
    /// Reads and checks everything the command names.
    ///
    /// # Errors
    /// Every fault found in the first file that has any, a plugin that is not trusted.
    pub fn open(args: &CellArgs) -> Result<Self> {
        let mut registry = builtin::registry();
        builtin::load(&mut registry, &args.libraries)?;
        let known = registry.known();
        let task = Task::read(&args.skill, &known).map_err(Faults)?;
        let unknown = files::unknown_objects(&args.skill, &task.objects());
        if !unknown.is_empty() {
            return Err(Faults(unknown).into());
        }
        let scene = Scene::read(&args.scene, &known).map_err(Faults)?;
        let robot_file = RobotFile::read(&args.robot, &known).map_err(Faults)?;
        let robot = robot_file.model()?;
        let config = configuration(&scene, &robot_file);
        let overrides = args.methods.clone();
        Ok(Self { task, scene, robot_file, registry, robot, overrides, config })
    }

    /// Which plugin does what in a run of a skill of the task.
    ///
    /// # Errors
    /// An unknown method.
    pub fn methods(&self, used: &SkillUse) -> Result<Methods, Diagnostic> {
        let (scene, robot) = (&self.scene, &self.robot_file);
        Methods::resolve(&used.skill, scene, robot, &self.overrides, &self.registry)
    }

    /// The assignment of a run of a skill of the task.
    ///
    /// # Errors
    /// An unknown method, a cloud that cannot be read, a frame that the scene has not, weights
    /// that cannot be read.
    pub fn assignment(&self, used: &SkillUse) -> Result<Assignment> {
        let methods = self.methods(used)?;
        let provenance = builtin::provenance(&methods)?;
        let (scene, robot) = (self.scene.clone(), self.robot.clone());
        let mut assignment =
            Assignment::bound(used.skill.clone(), scene, robot, methods, &used.targets)?;
        assignment.robot_name.clone_from(&self.robot_file.name);
        assignment.provenance = provenance;
        Ok(assignment)
    }

    fn cell(&self, simulated: &SimulatedCell, seed: u64) -> plugins::Cell<'_> {
        let world = Some(simulated.world());
        plugins::Cell {
            config: &self.config,
            root: Path::new("."),
            seed,
            robot: &self.robot,
            world,
        }
    }
}

/// The simulated cell of a task.
pub struct TaskCell {
    site: Rc<Site>,
    simulated: SimulatedCell,
    /// The methods of the plugins that are in use.
    methods: Methods,
    seed: u64,
    /// Objects laid there after the first.
    laid: u64,
}

impl TaskCell {
    /// The cell into which `object` has been dropped, and the plugins of the task's first run.
    ///
    /// # Errors
    /// As [`SimulatedCell::drop`], or when a plugin cannot be built.
    pub fn new(site: Rc<Site>, object: Object, seed: u64) -> Result<(Self, Plugins)> {
        let first = *site.task.uses().first().context("a task that was read has a skill")?;
        let methods = site.methods(first)?;
        let simulated =
            SimulatedCell::drop(&site.scene, object, seed).context("the simulated cell")?;
        let judge = Box::new(simulated.judge());
        let cell = site.cell(&simulated, seed);
        let plugins = Plugins::build(&site.registry, &methods, &cell, Some(judge))?;
        Ok((Self { site, simulated, methods, seed, laid: 0 }, plugins))
    }

    fn lay(&mut self, object: &str) -> Result<String> {
        self.laid += 1;
        let seed = self.seed.wrapping_add(self.laid);
        let object = objects::for_attempt(object, seed)?;
        let name = object.name().to_owned();
        self.simulated.exchange(SimulatedCell::drop(&self.site.scene, object, seed)?)?;
        Ok(name)
    }
}

impl task::Cell for TaskCell {
    fn present(&mut self, object: &str, plugins: &mut Plugins) -> Result<String, String> {
        let name = self.lay(object).map_err(|fault| format!("{fault:#}"))?;
        plugins.judge = Some(Box::new(self.simulated.judge()));
        Ok(name)
    }

    fn equip(&mut self, methods: &Methods, plugins: &mut Plugins) -> Result<(), String> {
        let cell = self.site.cell(&self.simulated, self.seed);
        task::exchange(plugins, &self.site.registry, [&self.methods, methods], &cell)
            .map_err(|fault| fault.to_string())?;
        self.methods = methods.clone();
        Ok(())
    }
}
