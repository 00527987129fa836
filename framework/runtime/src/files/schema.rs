//! JSON Schemas of the files, made of the structures by which they are read.

use super::codes::Family;
use super::robot_file::RawRobot;
use super::scene_file::RawScene;
use super::skill_file::RawSkill;
use super::task_file::RawTask;
use schemars::schema_for;
use serde_json::Value;

/// The JSON Schema (draft 2020-12) of a kind of file, for editors: types, keys, ranges and what
/// each key means. What lies between keys is `check`'s alone.
pub fn schema(family: Family) -> Value {
    let schema = match family {
        Family::Skill => schema_for!(RawSkill),
        Family::Task => schema_for!(RawTask),
        Family::Scene => schema_for!(RawScene),
        Family::Robot => schema_for!(RawRobot),
    };
    schema.to_value()
}
