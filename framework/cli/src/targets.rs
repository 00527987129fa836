//! Files of poses and of paths for `ik`: JSON, read into poses that are poses.

use crate::faults::Faults;
use nalgebra::{Matrix3, Rotation3, Translation3, UnitQuaternion};
use seeone_core::{Diagnostic, Pose};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// The largest file that is read: two hours of path at 125 poses a second.
const MOST_BYTES: u64 = 64 << 20;
/// By how much the products of a rotation's columns may miss those of an orthonormal one:
/// what is written with four digits passes.
const ORTHONORMAL: f64 = 1e-3;

/// What is asked under one id.
#[derive(Clone, Debug, PartialEq)]
pub struct Target<T> {
    /// A number or a text, handed back with the answer.
    pub id: Value,
    /// The pose or poses.
    pub wanted: T,
}

/// Reads an array of `{"id", "pose"}`; whatever else an entry holds is passed over.
///
/// # Errors
/// Every fault of the file: `I001` unreadable, `I002` no JSON, `I003` not finite, `I004` not
/// of this structure, `I005` no pose.
pub fn poses(file: &Path) -> Result<Vec<Target<Pose>>, Faults> {
    targets(file, "pose", |value| pose(value).map_err(|fault| vec![fault]))
}

/// Reads an array of `{"id", "poses"}`.
///
/// # Errors
/// As [`poses`].
pub fn paths(file: &Path) -> Result<Vec<Target<Vec<Pose>>>, Faults> {
    targets(file, "poses", |value| {
        let Some(values) = value.as_array().filter(|values| !values.is_empty()) else {
            return Err(vec![structure("is not an array of at least one pose")]);
        };
        let each = values.iter().enumerate();
        gathered(each.map(|(k, value)| pose(value).map_err(|f| vec![within(f, &format!("[{k}]"))])))
    })
}

fn targets<T>(
    file: &Path,
    key: &str,
    read: impl Fn(&Value) -> Result<T, Vec<Diagnostic>>,
) -> Result<Vec<Target<T>>, Faults> {
    let told = |faults: Vec<Diagnostic>| {
        Faults(faults.into_iter().map(|fault| placed(fault, file)).collect())
    };
    let text = text(file).map_err(|fault| told(vec![fault]))?;
    let whole: Value =
        serde_json::from_str(&text).map_err(|error| told(vec![syntax(&error, &text, file)]))?;
    let Some(entries) = whole.as_array() else {
        return Err(told(vec![structure("the file is not an array of targets")]));
    };
    let target = |(index, entry): (usize, &Value)| {
        let name = match entry.get("id") {
            Some(id) => format!("target {index} (id {id})"),
            None => format!("target {index}"),
        };
        let wrong = |cause: &str| vec![structure(&format!("{name}: {cause}"))];
        let id = match entry.get("id") {
            Some(id @ (Value::Number(_) | Value::String(_))) => id.clone(),
            Some(_) => return Err(wrong("\"id\" is neither a number nor a text")),
            None => return Err(wrong("the key \"id\" is missing")),
        };
        let value =
            entry.get(key).ok_or_else(|| wrong(&format!("the key \"{key}\" is missing")))?;
        let inside = |fault| within(fault, &format!("{name}: {key}"));
        let wanted = read(value).map_err(|f| f.into_iter().map(inside).collect::<Vec<_>>())?;
        Ok(Target { id, wanted })
    };
    gathered(entries.iter().enumerate().map(target)).map_err(told)
}

/// All values, or all faults.
fn gathered<T>(
    results: impl Iterator<Item = Result<T, Vec<Diagnostic>>>,
) -> Result<Vec<T>, Vec<Diagnostic>> {
    let (mut values, mut faults) = (Vec::new(), Vec::new());
    for result in results {
        match result {
            Ok(value) => values.push(value),
            Err(found) => faults.extend(found),
        }
    }
    if faults.is_empty() { Ok(values) } else { Err(faults) }
}

/// A rigid transform from its matrix, four rows of four or all sixteen numbers row by row.
fn pose(value: &Value) -> Result<Pose, Diagnostic> {
    let shape = || structure("is not a 4x4 matrix of numbers");
    let rows = value.as_array().ok_or_else(shape)?;
    let row = |row: &Value| row.as_array().filter(|row| row.len() == 4).cloned();
    let entries = match rows.len() {
        4 => rows.iter().map(row).collect::<Option<Vec<_>>>().ok_or_else(shape)?.concat(),
        16 => rows.clone(),
        _ => return Err(shape()),
    };
    let numbers: Option<Vec<f64>> = entries.iter().map(Value::as_f64).collect();
    let m = numbers.ok_or_else(shape)?;
    let fault = |cause: String| Diagnostic::new("I005", cause);
    if m[12..] != [0.0, 0.0, 0.0, 1.0] {
        return Err(fault(format!("its last row is {:?}, not [0, 0, 0, 1]", &m[12..])));
    }
    let rotation = Matrix3::new(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]);
    let off = (rotation.tr_mul(&rotation) - Matrix3::identity()).amax();
    // A comparison that an overflow to NaN fails.
    let orthonormal = off <= ORTHONORMAL;
    if !orthonormal {
        return Err(fault(format!("its rotation is not orthonormal: off by {off:.3}")));
    }
    if rotation.determinant() < 0.0 {
        return Err(fault("its rotation is a reflection: the determinant is -1".into()));
    }
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix(&rotation));
    Ok(Pose::from_parts(Translation3::new(m[3], m[7], m[11]), turn))
}

fn text(file: &Path) -> Result<String, Diagnostic> {
    let fault = |cause: String| Diagnostic::new("I001", cause);
    let unreadable = |e: std::io::Error| fault(format!("cannot be read: {e}"));
    let size = fs::metadata(file).map_err(unreadable)?.len();
    if size > MOST_BYTES {
        return Err(fault(format!("{size} bytes, but a file of targets may have {MOST_BYTES}")));
    }
    fs::read_to_string(file).map_err(unreadable)
}

/// Where the text stops being JSON. NaN and its kind are what programs write there.
fn syntax(error: &serde_json::Error, text: &str, file: &Path) -> Diagnostic {
    let (line, column) = (error.line().max(1), error.column().max(1));
    let from = text.lines().nth(line - 1).and_then(|l| l.get(column - 1..)).unwrap_or_default();
    let written = ["NaN", "-NaN", "Infinity", "-Infinity", "nan", "inf", "-inf"];
    // The parser stops one character into what begins like a number.
    let not_finite =
        written.iter().find(|word| from.starts_with(**word) || from.starts_with(&word[1..]));
    let fault = match not_finite {
        Some(word) => Diagnostic::new("I003", format!("{word} is not a finite number")),
        None if error.to_string().starts_with("number out of range") => {
            Diagnostic::new("I003", "a number is too large")
        }
        None => Diagnostic::new("I002", format!("is no JSON: {error}")),
    };
    fault.at_line(file, line, column)
}

fn structure(cause: &str) -> Diagnostic {
    Diagnostic::new("I004", cause)
}

fn within(mut fault: Diagnostic, what: &str) -> Diagnostic {
    let gap = if fault.cause.starts_with('[') { "" } else { " " };
    fault.cause = format!("{what}{gap}{}", fault.cause);
    fault
}

fn placed(fault: Diagnostic, file: &Path) -> Diagnostic {
    if fault.place.is_some() { fault } else { fault.in_file(file) }
}
