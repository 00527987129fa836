//! The files a user writes: skills, tasks, scenes and robots.
//!
//! Each is TOML of at most 1 MiB with `schema = 1`, in SI units with the unit in the key.
//! It is parsed into a raw structure that refuses unknown keys, and resolved into a type
//! that cannot be invalid. Whatever is wrong is a [`seeone_core::Diagnostic`] with file,
//! line and column.

mod beside;
mod check;
mod codes;
mod exactly;
mod hook;
mod locate;
mod measure;
mod obstacle;
mod pose;
mod resolver;
mod robot_file;
mod scene;
mod scene_file;
mod schema;
mod shown_result;
mod skill;
mod skill_file;
mod skill_text;
mod source;
mod spanned;
mod task;
mod task_file;

pub use check::{check, family_of};
pub use codes::Family;
pub use locate::locate;
pub use resolver::is_name;
pub use robot_file::RobotFile;
pub use scene::{Beside, Drop, Head, Hook, Scene, Table, Targets};
pub use schema::schema;
pub use skill::{Demonstration, RelativeTo, ShownResult, Skill, Stage};
pub use task::{SkillUse, Task, TaskStep, Work};

use seeone_plugin::Kind;
use std::collections::BTreeMap;

/// The plugins there are, by kind: what a file may name. A kind that is not in it is not
/// checked.
pub type KnownMethods = BTreeMap<Kind, Vec<String>>;

#[cfg(test)]
mod tests;
