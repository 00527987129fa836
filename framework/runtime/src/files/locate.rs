//! The place of a value in a file that was read before: for faults that show only beside other
//! files.

use std::fs;
use std::path::Path;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// Where in the TOML file `path` the value of `keys` begins, line and column from one: a key of a
/// table or the index of an item for each step down. Of keys that are not there, the last that
/// is; the first line when the file cannot be read any more.
pub fn locate(path: &Path, keys: &[&str]) -> (usize, usize) {
    let text = fs::read_to_string(path).unwrap_or_default();
    let (table, _) = DeTable::parse_recoverable(&text);
    let offset = offset(table.get_ref(), keys).unwrap_or(0);
    let before = text.get(..offset).unwrap_or_default();
    let line = before.matches('\n').count() + 1;
    (line, before.chars().rev().take_while(|c| *c != '\n').count() + 1)
}

fn offset(table: &DeTable, keys: &[&str]) -> Option<usize> {
    let (first, rest) = keys.split_first()?;
    let (key, value) = table.iter().find(|(key, _)| key.get_ref() == first)?;
    let here = match value.get_ref() {
        DeValue::Table(_) => key.span(),
        _ => value.span(),
    };
    within(value, rest).or(Some(here.start))
}

fn within(value: &Spanned<DeValue>, keys: &[&str]) -> Option<usize> {
    match value.get_ref() {
        DeValue::Table(table) => offset(table, keys),
        DeValue::Array(items) => {
            let (first, rest) = keys.split_first()?;
            let item = items.get(first.parse::<usize>().ok()?)?;
            within(item, rest).or(Some(item.span().start))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    #[test]
    fn a_value_is_found_by_its_keys_and_else_what_lies_around_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.toml");
        fs::write(&path, "a = 1\n[[stage]]\nb = 2\n[[stage]]\nb = { c = 3 }\n[d.e]\nf = 4\n")
            .unwrap();
        assert_eq!(locate(&path, &["stage", "1", "b", "c"]), (5, 11));
        assert_eq!(locate(&path, &["stage", "0", "b"]), (3, 5));
        assert_eq!(locate(&path, &["stage", "0", "none"]), (2, 1));
        assert_eq!(locate(&path, &["d", "e", "f"]), (7, 5));
        assert_eq!(locate(&path, &["d", "e", "none"]), (6, 4));
        assert_eq!(locate(&path, &["d", "e"]), (6, 4));
        assert_eq!(locate(&path, &["none"]), (1, 1));
        assert_eq!(locate(&folder.path().join("none"), &["a"]), (1, 1));
    }
}
