//! The text of one file, read and parsed so that every fault is told with its place.

use super::codes::{Family, Fault};
use seeone_core::Diagnostic;
use serde::de::DeserializeOwned;
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::de::{DeTable, DeValue, Error};

/// The largest file that is read: a larger one costs seconds to parse.
const MOST_BYTES: u64 = 1 << 20;

/// The text of one file and what it is meant to be.
#[derive(Debug)]
pub(super) struct Source {
    pub(super) family: Family,
    pub(super) path: PathBuf,
    text: String,
}

impl Source {
    /// Reads a file of at most 1 MiB of UTF-8.
    pub(super) fn open(family: Family, path: &Path) -> Result<Self, Diagnostic> {
        let fault =
            |cause: String| Diagnostic::new(family.code(Fault::Unreadable), cause).in_file(path);
        let size = fs::metadata(path).map_err(|e| fault(format!("cannot be read: {e}")))?.len();
        if size > MOST_BYTES {
            return Err(fault(format!("{size} bytes, but a file may have {MOST_BYTES}")));
        }
        let bytes = fs::read(path).map_err(|e| fault(format!("cannot be read: {e}")))?;
        let text = String::from_utf8(bytes).map_err(|e| {
            fault(format!("byte {} is not UTF-8 text", e.utf8_error().valid_up_to()))
        })?;
        Ok(Self { family, path: path.to_owned(), text })
    }

    /// The folder against which the file names others.
    pub(super) fn folder(&self) -> &Path {
        self.path.parent().unwrap_or(Path::new(""))
    }

    /// A fault at a place of this file.
    pub(super) fn fault(
        &self,
        fault: Fault,
        at: Range<usize>,
        cause: impl Into<String>,
    ) -> Diagnostic {
        Diagnostic::new(self.family.code(fault), cause).at_offset(&self.path, &self.text, at.start)
    }

    /// The names of the top level, or every fault of syntax.
    pub(super) fn keys(&self) -> Result<Vec<String>, Vec<Diagnostic>> {
        let (table, errors) = DeTable::parse_recoverable(&self.text);
        if errors.is_empty() {
            return Ok(table.get_ref().keys().map(|key| key.get_ref().to_string()).collect());
        }
        Err(errors.iter().map(|error| self.syntax(error)).collect())
    }

    /// Parses the text: syntax first, then finite numbers, the schema's number, and then
    /// the structure that `T` asks for.
    pub(super) fn parse<T: DeserializeOwned>(&self) -> Result<T, Vec<Diagnostic>> {
        self.keys()?;
        let table = DeTable::parse(&self.text).map_err(|error| vec![self.syntax(&error)])?;
        let mut faults = Vec::new();
        for (_, value) in table.get_ref().iter() {
            self.finite(value, &mut faults);
        }
        faults.extend(self.schema(table.get_ref()).err());
        if !faults.is_empty() {
            return Err(faults);
        }
        toml::from_str(&self.text).map_err(|error| vec![self.structure(&error)])
    }

    fn syntax(&self, error: &Error) -> Diagnostic {
        self.fault(Fault::Syntax, error.span().unwrap_or(0..0), error.message().trim())
    }

    fn finite(&self, value: &toml::Spanned<DeValue>, faults: &mut Vec<Diagnostic>) {
        match value.get_ref() {
            DeValue::Float(number) if !number.as_str().parse::<f64>().is_ok_and(f64::is_finite) => {
                let cause = format!("{} is not a finite number", number.as_str());
                faults.push(self.fault(Fault::NotFinite, value.span(), cause));
            }
            DeValue::Array(items) => items.iter().for_each(|item| self.finite(item, faults)),
            DeValue::Table(table) => {
                table.iter().for_each(|(_, item)| self.finite(item, faults));
            }
            _ => {}
        }
    }

    fn schema(&self, table: &DeTable) -> Result<(), Diagnostic> {
        let Some(value) = table.get("schema") else {
            let fault = self.fault(Fault::Schema, 0..0, "the file does not say its schema");
            return Err(fault.hint("begin it with: schema = 1"));
        };
        match value.get_ref() {
            DeValue::Integer(number) if number.as_str() == "1" && number.radix() == 10 => Ok(()),
            _ => Err(self
                .fault(Fault::Schema, value.span(), "this schema is not known")
                .hint("this version reads: schema = 1")),
        }
    }

    /// What serde found, in the words of the file: `unknown key "spede"`.
    fn structure(&self, error: &Error) -> Diagnostic {
        let at = error.span().unwrap_or(0..0);
        let message = error.message().trim();
        let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
        if message.starts_with("unknown field") && !quoted.is_empty() {
            let cause = format!("unknown key \"{}\"", quoted[0]);
            let known = quoted[1..].iter().copied();
            return self.fault(Fault::UnknownKey, at, cause).suggest(quoted[0], known);
        }
        if message.starts_with("missing field") && !quoted.is_empty() {
            return self.fault(
                Fault::MissingKey,
                at,
                format!("the key \"{}\" is missing", quoted[0]),
            );
        }
        self.fault(Fault::WrongType, at, in_words_of_the_file(message))
    }
}

/// A fault of type, where serde speaks of Rust's types.
fn in_words_of_the_file(message: &str) -> String {
    let words = [
        ("expected f64", "expected a number"),
        ("expected u32", "expected a whole number from 0"),
        ("expected usize", "expected a whole number from 0"),
        ("expected a sequence", "expected a list"),
        ("invalid type: sequence", "invalid type: a list"),
        ("invalid type: map", "invalid type: a table"),
        ("expected a map", "expected a table"),
    ];
    let told = words.iter().fold(message.to_owned(), |told, (from, to)| told.replace(from, to));
    match told.split_once("expected struct ") {
        Some((before, _)) => format!("{before}expected a table"),
        None => told,
    }
}
