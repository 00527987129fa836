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
    let mut schema = schema.to_value();
    without_null(&mut schema);
    schema
}

/// TOML knows no null: what is not said is left out.
fn without_null(schema: &mut Value) {
    let null = |one: &Value| one == "null" || one["type"] == "null";
    if let Some(of) = schema.as_object_mut() {
        for key in ["type", "anyOf"] {
            let Some(Value::Array(choices)) = of.get_mut(key) else { continue };
            choices.retain(|one| !null(one));
            if let [only] = &choices[..] {
                let only = only.clone();
                match only {
                    Value::Object(only) => {
                        of.remove(key);
                        of.extend(only);
                    }
                    only => _ = of.insert(key.to_owned(), only),
                }
            }
        }
    }
    match schema {
        Value::Object(of) => of.values_mut().for_each(without_null),
        Value::Array(items) => items.iter_mut().for_each(without_null),
        _ => {}
    }
}
