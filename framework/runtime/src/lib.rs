//! Files, plugins, runs of skills, and tasks made of them.
//!
//! What a binary does with it:
//! ```text
//! let mut registry = Registry::new();
//! registry.perception.add("nst", |setup| Ok(Box::new(Nst::from_setup(setup)?)));   // ... each plugin
//! let skill = Skill::read(path, &registry.known())?;                               // Scene, RobotFile
//! let methods = Methods::resolve(&skill, &scene, &robot_file, &overrides, &registry)?;
//! let robot = robot_file.model()?;
//! let config = configuration(&scene, &robot_file);
//! let cell = Cell { config: &config, root, seed, robot: &robot, world: Some(world) };
//! let plugins = Plugins::build(&registry, &methods, &cell, Some(judge))?;
//! let mut assignment = Assignment::new(skill, scene, robot, methods)?;
//! assignment.seed = seed;                                                          // object, recording, ...
//! let finished = run(assignment, plugins, Hooks { clock, progress, cancel });
//! println!("{}", serde_json::to_string(&finished.outcome)?);
//! ```
//! The runtime names no plugin and reads no clock: both are handed in.

pub mod files;
pub mod methods;
pub mod plugins;
pub mod record;
pub mod registry;
pub mod run;
pub mod task;
pub mod transfer;

#[cfg(test)]
mod fakes;

pub use files::{Family, KnownMethods, RobotFile, Scene, Skill, Task, check};
pub use methods::{Methods, parse_override};
pub use plugins::{Cell, Plugins, configuration};
pub use registry::Registry;
pub use run::{Assignment, Finished, Hooks, Outcome, StageEvent, run};
pub use task::{TaskHooks, TaskOutcome, run_task};
