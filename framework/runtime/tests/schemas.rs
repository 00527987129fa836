//! The committed JSON Schemas are those of the structures that read the files, and take every
//! file that comes with the project.

use seeone_runtime::files::{Family, schema};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[test]
fn the_committed_schemas_are_those_of_the_structures() {
    for family in Family::ALL {
        let path = repository().join(format!("docs/schemas/{}.json", family.name()));
        let committed = fs::read_to_string(&path).unwrap_or_default();
        let now = serde_json::to_string_pretty(&schema(family)).expect("JSON") + "\n";
        assert!(
            committed == now,
            "{} is not what `seeone schema {}` prints; write it anew",
            path.display(),
            family.name()
        );
    }
}

#[test]
fn every_shipped_file_is_taken_and_an_unknown_key_is_not() {
    let folders = [
        ("skills", Family::Skill),
        ("skills/tasks", Family::Task),
        ("scenes", Family::Scene),
        ("robots", Family::Robot),
    ];
    for (folder, family) in folders {
        let schema = schema(family);
        let mut taken = 0;
        for entry in fs::read_dir(repository().join(folder)).expect("the folder is there") {
            let path = entry.expect("an entry").path();
            if path.extension().is_none_or(|extension| extension != "toml") {
                continue;
            }
            let text = fs::read_to_string(&path).expect("text");
            let mut file = serde_json::to_value(text.parse::<toml::Table>().expect("TOML"))
                .expect("a table is JSON");
            assert_eq!(refusal(&file, &schema, &schema), None, "{}", path.display());
            file["spede"] = 1.into();
            let told = refusal(&file, &schema, &schema).expect("an unknown key is refused");
            assert!(told.contains("spede"), "{told}");
            taken += 1;
        }
        assert!(taken > 0, "{folder}");
    }
}

#[test]
fn a_schema_tells_types_ranges_and_what_keys_mean() {
    let skill = schema(Family::Skill);
    let lift = &skill["$defs"]["stage"]["properties"]["lift_m"];
    assert!(lift["description"].as_str().is_some_and(|told| told.contains("metres")), "{lift}");
    for (lift_m, taken) in [(0.25, true), (2.5, false), (-0.1, false)] {
        let refused = refusal(&lift_m.into(), lift, &skill);
        assert_eq!(refused.is_none(), taken, "{lift_m}: {refused:?}");
    }
    assert!(refusal(&"high".into(), lift, &skill).is_some());
    assert_eq!(schema(Family::Task)["properties"]["schema"]["const"], 1);
}

/// Why a value is not what a schema asks for, by the words of JSON Schema that these use.
fn refusal(value: &Value, schema: &Value, root: &Value) -> Option<String> {
    if let Some(name) = schema["$ref"].as_str() {
        let target =
            root.pointer(name.trim_start_matches('#')).expect("a reference leads somewhere");
        return refusal(value, target, root);
    }
    if let Some(any) = schema["anyOf"].as_array() {
        let refusals: Option<Vec<_>> = any.iter().map(|one| refusal(value, one, root)).collect();
        return refusals.map(|all| all.join(" and "));
    }
    let named = |kind: &str| match kind {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "number" => value.is_number(),
        "integer" => value.is_u64() || value.is_i64(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        other => panic!("a type {other}"),
    };
    let fits = match &schema["type"] {
        Value::String(kind) => named(kind),
        Value::Array(kinds) => kinds.iter().filter_map(Value::as_str).any(named),
        _ => true,
    };
    if !fits {
        return Some(format!("{value} is no {}", schema["type"]));
    }
    if schema.get("const").is_some_and(|only| value != only) {
        return Some(format!("{value} is not {}", schema["const"]));
    }
    if let Some(number) = value.as_f64() {
        let below = schema["minimum"].as_f64().is_some_and(|least| number < least);
        let above = schema["maximum"].as_f64().is_some_and(|most| number > most);
        return (below || above).then(|| format!("{number} is out of range"));
    }
    if let Some(items) = value.as_array() {
        let most = schema["maxItems"].as_u64().is_some_and(|most| items.len() as u64 > most);
        let least = schema["minItems"].as_u64().is_some_and(|least| (items.len() as u64) < least);
        if most || least {
            return Some(format!("{} items", items.len()));
        }
        return items.iter().find_map(|item| match &schema["items"] {
            Value::Object(_) => refusal(item, &schema["items"], root),
            _ => None,
        });
    }
    let keys = value.as_object()?;
    let required = schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str);
    if let Some(missing) = required.into_iter().find(|key| !keys.contains_key(*key)) {
        return Some(format!("{missing} is missing"));
    }
    keys.iter().find_map(|(key, value)| match schema["properties"].get(key) {
        Some(schema) => refusal(value, schema, root),
        None => match &schema["additionalProperties"] {
            Value::Bool(false) => Some(format!("unknown key {key}")),
            Value::Object(_) => refusal(value, &schema["additionalProperties"], root),
            _ => None,
        },
    })
}
